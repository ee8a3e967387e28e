import {
  FloatType, GLSL3, HalfFloatType, NearestFilter, RawShaderMaterial, RGBAFormat, Vector3, WebGLRenderTarget,
  type WebGLRenderer,
} from 'three';
import { FullScreen, fullScreenVertex } from './full_screen';
import type { Layout } from './layout';
import { kNodesInRow, lobeGlsl, type LobeTextures } from './lobe_textures';

/**
 * The light of every glossy node towards an eye: a small picture with one pixel a node, from which the elements'
 * corners read. So a lobe is evaluated once for an eye, however many triangles share its node and however often a
 * vertex shader runs for it, and not at all while only exposure, curve or the window change.
 *
 * Between nodes, light should be Σ φ_k L_k(ω) with ω from the place that is seen (format.md#3); with ω from the nodes,
 * Σ φ_k L_k(ω_k), large elements near the eye look faceted. The difference is of second order in the element's size, and
 *
 *     Σ φ_k (L_k(ω_k) + ½ ∇L_k · (ω - ω_k))
 *
 * leaves a third: the half makes linear interpolation with slopes at its ends exact for squares. So each channel's pixel is
 * (½ ∇L, L - ½ ∇L · ω_k), which is linear in the nodes, and a fragment adds the product of the first with its own ω.
 * ∇ is over the disc, in world axes.
 */
export class NodeLight {
  readonly target: WebGLRenderTarget;
  private readonly pass: FullScreen;
  private readonly eye = new Vector3(NaN, NaN, NaN);
  private degree = -1;

  constructor(layout: Layout, private readonly lobes: LobeTextures, floats: boolean) {
    const count = layout.nodeCount - layout.flatCount;
    this.target = new WebGLRenderTarget(kNodesInRow, Math.max(1, Math.ceil(count / kNodesInRow)), {
      count: 3,  // red, green, blue
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
        layout(location = 0) out vec4 red;
        layout(location = 1) out vec4 green;
        layout(location = 2) out vec4 blue;
        void main() {
          int i = int(gl_FragCoord.y) * ${kNodesInRow} + int(gl_FragCoord.x);
          if (i >= count) discard;
          ivec2 row = ivec2((i % ${kNodesInRow}) * 2, i / ${kNodesInRow});
          uvec4 place = texelFetch(table, row, 0), way = texelFetch(table, row + ivec2(1, 0), 0);
          vec3 wo = normalize(eye - uintBitsToFloat(place.xyz));
          // docs/conventions.md#frame
          vec3 n = uintBitsToFloat(way.xyz);
          // By the sign's own bit: -0 has one, too.
          float s = (way.z >> 31) != 0u ? -1.0 : 1.0, a = -1.0 / (s + n.z), b = n.x * n.y * a;
          vec3 ex = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), ey = vec3(b, s + n.y * n.y * a, -n.y);
          // docs/conventions.md#horizon
          vec2 disc = vec2(dot(ex, wo), dot(ey, wo));
          bool above = dot(n, wo) >= 0.0;
          if (!above) disc = dot(disc, disc) > 0.0 ? normalize(disc) : vec2(1.0, 0.0);
          vec3 alongX, alongY;
          vec3 light = lobeOf(int(place.w), min(int(way.w), degree), disc, alongX, alongY);
          // What is bent to the horizon stays there.
          mat3 slope = above ? 0.5 * (outerProduct(ex, alongX) + outerProduct(ey, alongY)) : mat3(0.0);
          red = vec4(slope[0], light.r - dot(slope[0], wo));
          green = vec4(slope[1], light.g - dot(slope[1], wo));
          blue = vec4(slope[2], light.b - dot(slope[2], wo));
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
}
