/** The element that was clicked: its outline and its nodes, the one that is inspected larger. */
import {
  BufferAttribute, BufferGeometry, Color, Group, LineLoop, Points, ShaderMaterial, type Material,
} from 'three';
import type { Solution } from '../solution/solution';
import { findNode } from '../solution/solution';

// Both lie in the surface: towards the eye by a thousandth of the way, they are never lost in it.
const kPosition = `
      vec4 seen = modelViewMatrix * vec4(position, 1.0);
      seen.xyz *= 0.999;
      gl_Position = projectionMatrix * seen;`;

const dots = {
  vertexShader: `
    attribute float size;
    uniform float pixelRatio;
    varying float radius;
    void main() {${kPosition}
      radius = size * pixelRatio;
      gl_PointSize = 2.0 * radius + 2.0;
    }`,
  fragmentShader: `
    uniform vec3 colour;
    uniform float pixelRatio;
    varying float radius;
    void main() {
      float r = length(gl_PointCoord - 0.5) * (2.0 * radius + 2.0);
      float inside = clamp(radius - r + 0.5, 0.0, 1.0);
      if (inside == 0.0) discard;
      // A dark rim, the colour, and in the middle of large ones white: seen on walls of any colour.
      float ring = clamp(radius - 1.5 * pixelRatio - r + 0.5, 0.0, 1.0);
      float core = clamp(radius - 4.0 * pixelRatio - r + 0.5, 0.0, 1.0);
      gl_FragColor = vec4(mix(mix(vec3(0.004), colour, ring), vec3(1.0), core), inside);
      #include <colorspace_fragment>
    }`,
};

const line = {
  vertexShader: `
    void main() {${kPosition}
    }`,
  fragmentShader: `
    uniform vec3 colour;
    void main() {
      gl_FragColor = vec4(mix(colour, vec3(1.0), 0.4), 0.9);
      #include <colorspace_fragment>
    }`,
};

export class Markers {
  readonly object = new Group();
  private readonly points: Points;
  private readonly outline: LineLoop;

  constructor(colour: string) {
    const uniforms = { colour: { value: new Color(colour) }, pixelRatio: { value: 1 } };
    this.points = new Points(new BufferGeometry(), new ShaderMaterial({ ...dots, uniforms, transparent: true, depthWrite: false }));
    this.outline = new LineLoop(new BufferGeometry(), new ShaderMaterial({ ...line, uniforms, transparent: true, depthWrite: false }));
    // The screen's, which changes with the window's place and the browser's zoom.
    this.points.onBeforeRender = () => (uniforms.pixelRatio.value = window.devicePixelRatio);
    this.object.add(this.outline, this.points);
    for (const part of this.object.children) part.frustumCulled = false;
  }

  /** `element`: nodes of the whole solution. */
  show(solution: Solution, element: readonly number[], node: number): void {
    const positions = new Float32Array(3 * element.length);
    element.forEach((n, i) => {
      const found = findNode(solution, n)!;
      positions.set(found.patch.positions.subarray(3 * found.local, 3 * found.local + 3), 3 * i);
    });
    const attribute = new BufferAttribute(positions, 3);
    this.outline.geometry.dispose();
    this.outline.geometry = new BufferGeometry().setAttribute('position', attribute);
    this.points.geometry.dispose();
    this.points.geometry = new BufferGeometry()
      .setAttribute('position', attribute)
      .setAttribute('size', new BufferAttribute(Float32Array.from(element, (n) => (n === node ? 6.5 : 4)), 1));
  }

  dispose(): void {
    for (const part of [this.points, this.outline]) {
      part.geometry.dispose();
      (part.material as Material).dispose();
    }
  }
}

/** An element that a node is a corner of, for nodes that were named and not clicked. */
export function elementOf(solution: Solution, node: number): number[] {
  const found = findNode(solution, node);
  if (!found) return [node];
  const { indices, firstNode } = found.patch;
  const at = indices.indexOf(found.local);
  if (at < 0) return [node];
  const first = at - (at % 3);
  return [0, 1, 2].map((k) => firstNode + indices[first + k]);
}
