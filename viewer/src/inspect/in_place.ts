/** A lobe where it is: a surface on its node, in the stage's overlay. */
import {
  BufferAttribute, BufferGeometry, Color, DoubleSide, Group, LineBasicMaterial, LineSegments, Matrix4, Mesh,
  ShaderMaterial, Vector3,
} from 'three';
import type { ToneCurve } from '../draw/settings';
import { toneMap } from '../draw/tone_curves';
import { kGhostColour, kNegativeColour } from './colours';
import type { Inspection } from './inspection';
import { surfaceOf } from './surface';

export interface Look {
  /** Metres that `reach` (W m⁻² sr⁻¹) is drawn long. */
  size: number;
  reach: number;
  /** Of the picture: the lobe's colours are what an eye there would see of the node. */
  exposure: number;
  curve: ToneCurve;
  /** One colour for the whole lobe instead, to tell two apart. */
  tint: string | null;
}

// Colours are what the picture shows; a little light from the eye lets the shape be seen without changing the hue.
const vertexShader = `
  attribute vec3 color;
  varying vec3 shown;
  varying vec3 seen;
  varying vec3 across;
  void main() {
    shown = color;
    vec4 at = modelViewMatrix * vec4(position, 1.0);
    seen = at.xyz;
    across = normalMatrix * normal;
    gl_Position = projectionMatrix * at;
  }`;
const fragmentShader = `
  varying vec3 shown;
  varying vec3 seen;
  varying vec3 across;
  void main() {
    float facing = abs(dot(normalize(across), normalize(seen)));
    gl_FragColor = vec4(shown * mix(0.4, 1.0, facing), 1.0);
    #include <colorspace_fragment>
  }`;

export class LobeInPlace {
  readonly object = new Group();
  private readonly surface: Mesh;
  private readonly lines: LineSegments;
  private readonly ghost: LineSegments;

  constructor() {
    this.surface = new Mesh(
      new BufferGeometry(),
      new ShaderMaterial({
        vertexShader, fragmentShader, side: DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
      }));
    const line = (opacity: number) =>
      new LineBasicMaterial({ color: kGhostColour, transparent: true, opacity, depthWrite: false });
    this.lines = new LineSegments(new BufferGeometry(), line(0.3));
    this.ghost = new LineSegments(new BufferGeometry(), line(0.16));
    this.object.add(this.surface, this.lines, this.ghost);
    for (const part of this.object.children) part.frustumCulled = false;
    this.object.matrixAutoUpdate = false;
  }

  /** Shows `i`; nothing if its patch is black. */
  show(i: Inspection, look: Look): void {
    const { shown, whole } = i;
    this.object.visible = shown !== null && look.reach > 0;
    if (!shown || !whole || !this.object.visible) return;
    const { x, y, z } = i.frame, scale = look.size / look.reach;
    this.object.matrix
      .makeBasis(new Vector3(...x), new Vector3(...y), new Vector3(...z))
      // A hair above the surface, so that what leaves along it is not lost in it.
      .setPosition(new Vector3(...i.position).addScaledVector(new Vector3(...z), 0.004 * look.size))
      .multiply(new Matrix4().makeScale(scale, scale, scale));
    this.object.matrixWorldNeedsUpdate = true;

    const surface = surfaceOf(shown, whole.lMax);
    const colours = coloursOf(surface.radiance, surface.luminance, look);
    const positions = new BufferAttribute(surface.positions, 3);
    const shape = replace(this.surface, positions, surface.triangles);
    shape.setAttribute('color', new BufferAttribute(colours, 3));
    shape.computeVertexNormals();
    replace(this.lines, positions, surface.lines);
    this.ghost.visible = shown.lMax < whole.lMax;
    if (this.ghost.visible) {
      const all = surfaceOf(whole);
      replace(this.ghost, new BufferAttribute(all.positions, 3), all.lines);
    }
  }

  dispose(): void {
    for (const part of [this.surface, this.lines, this.ghost]) {
      part.geometry.dispose();
      (part.material as ShaderMaterial | LineBasicMaterial).dispose();
    }
  }
}

function replace(part: Mesh | LineSegments, positions: BufferAttribute, index: Uint32Array): BufferGeometry {
  part.geometry.dispose();
  part.geometry = new BufferGeometry();
  part.geometry.setAttribute('position', positions);
  part.geometry.setIndex(new BufferAttribute(index, 1));
  return part.geometry;
}

/** Linear, per vertex. */
function coloursOf(radiance: Float32Array, luminance: Float32Array, look: Look): Float32Array {
  const out = new Float32Array(radiance.length);
  const negative = new Color(kNegativeColour), tint = look.tint === null ? null : new Color(look.tint);
  const scale = 2 ** look.exposure;
  for (let i = 0; i < luminance.length; ++i) {
    if (luminance[i] < 0) negative.toArray(out, 3 * i);
    else if (tint) tint.toArray(out, 3 * i);
    else for (let c = 0; c < 3; ++c) out[3 * i + c] = toneMap(look.curve, radiance[3 * i + c] * scale);
  }
  return out;
}
