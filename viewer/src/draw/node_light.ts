import { FloatType, GLSL3, HalfFloatType, NearestFilter, RawShaderMaterial, RGBAFormat, Vector3, WebGLRenderTarget, type WebGLRenderer } from 'three';
import { FullScreen, fullScreenVertex } from './full_screen';
import type { Layout } from './layout';
import { kNodesInRow, lobeGlsl, type LobeTextures } from './lobe_textures';

/**
 * The light of every glossy node towards an eye: a small picture with one pixel a node, from which the elements'
 * corners read. So a lobe is evaluated once for an eye, however many triangles share its node and however often a
 * vertex shader runs for it, and not at all while only exposure, curve or the window change.
 */
export class NodeLight {
  readonly target: WebGLRenderTarget;
  private readonly pass: FullScreen;
  private readonly eye = new Vector3(NaN, NaN, NaN);
  private degree = -1;

  constructor(layout: Layout, private readonly lobes: LobeTextures, floats: boolean) {
    const count = layout.nodeCount - layout.flatCount;
    this.target = new WebGLRenderTarget(kNodesInRow, Math.max(1, Math.ceil(count / kNodesInRow)), {
      format: RGBAFormat, type: floats ? FloatType : HalfFloatType, minFilter: NearestFilter, magFilter: NearestFilter,
      depthBuffer: false,
    });
    this.pass = new FullScreen(new RawShaderMaterial({
      glslVersion: GLSL3,
      depthTest: false,
      depthWrite: false,
      uniforms: { ...lobes.uniforms, eye: { value: new Vector3() }, count: { value: count } },
      vertexShader: fullScreenVertex,
      fragmentShader: /* glsl */ `
        precision highp float;
        precision highp int;
        ${lobeGlsl}
        uniform vec3 eye;
        uniform int count;
        out vec4 light;
        void main() {
          int i = int(gl_FragCoord.y) * ${kNodesInRow} + int(gl_FragCoord.x);
          if (i >= count) discard;
          light = vec4(lobeTowards(i, eye), 1.0);
        }`,
    }));
  }

  /** Leaves the render target changed. */
  evaluate(renderer: WebGLRenderer, eye: Vector3): void {
    const degree = this.lobes.uniforms.degree.value as number;
    if (this.eye.equals(eye) && this.degree === degree) return;
    this.eye.copy(eye);
    this.degree = degree;
    (this.pass.material.uniforms.eye.value as Vector3).copy(eye);
    renderer.setRenderTarget(this.target);
    this.pass.draw(renderer);
  }

  dispose(): void {
    this.target.dispose();
    this.pass.dispose();
  }
}
