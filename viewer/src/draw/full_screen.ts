import {
  BufferAttribute, BufferGeometry, Mesh, OrthographicCamera, Sphere, type RawShaderMaterial, type WebGLRenderer,
} from 'three';

const camera = new OrthographicCamera();

/** One triangle over the whole render target. */
export class FullScreen {
  private readonly mesh: Mesh;

  constructor(readonly material: RawShaderMaterial) {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array([-1, -1, 3, -1, -1, 3]), 2));
    geometry.boundingSphere = new Sphere();  // two coordinates a corner have none of their own
    this.mesh = new Mesh(geometry, material);
    this.mesh.frustumCulled = false;
  }

  draw(renderer: WebGLRenderer): void {
    renderer.render(this.mesh, camera);
  }
}

export const fullScreenVertex = /* glsl */ `
in vec2 position;
void main() {
  gl_Position = vec4(position, 0.0, 1.0);
}
`;
