/**
 * Mirrors and glass. Made only for scenes that have them.
 *
 * What they reflect comes from one of two pictures:
 * - *view*: the scene from the eye behind a plane, exact but that mirrors in it show probes. The kMostViews planes
 *   that look largest have one; coplanar parts share it.
 * - *probe*: a cube of pictures from one point near the part, looked up where the reflected ray leaves the scene's
 *   bounding box (as if all were there). For what is curved, for mirrors in mirrors, and for planes beyond the most.
 *   Mirrors in a probe show their base alone, and glass in it is not there.
 *
 * Glass lets see what lies behind straight through, without refraction: each surface passes transmission × (1 - F) and
 * adds F × what it reflects. Coloured bodies dim by their mean chord, whatever the way through them: half of it at each
 * of the two surfaces that are crossed. Parts are drawn from far to near, each its far sides first.
 */
import {
  AddEquation, BackSide, BufferAttribute, BufferGeometry, CubeCamera, CustomBlending, DoubleSide, DstColorFactor,
  FrontSide, Frustum, GLSL3, HalfFloatType, LinearFilter, Matrix4, Mesh, OneFactor, Plane, RawShaderMaterial, RGBAFormat,
  Scene, Vector2, Vector3, Vector4, WebGLCubeRenderTarget, WebGLRenderTarget, ZeroFactor, type Box3, type IUniform,
  type PerspectiveCamera, type Side, type WebGLRenderer,
} from 'three';
import type { Material, Rgb, Solution } from '../solution/solution';
import { kBrightest } from './backdrop';
import { elementsOf, isFlat, type Layout } from './layout';
import { MirroredCamera } from './reflection';
import { glassOf, isSame, mirrorsOf, type SpecularPart } from './specular_parts';
import { asMesh, plainMain, type Surfaces } from './surfaces';

const kMostViews = 4;
const kMostProbes = 8;
const kProbePixels = 128;
/** What lies behind a mirror by less is not cut off, in scene diagonals. */
const kSlack = 2e-5;

enum Source { none, view, probe }

interface Drawn {
  part: SpecularPart;
  meshes: Mesh[];
  uniforms: Record<'source' | 'view' | 'probe' | 'probeAt', IUniform>;
  probe: Probe;
}

interface Probe {
  at: Vector3;
  target: WebGLCubeRenderTarget;
}

/** The eye behind the mirror, and what it sees: for each picture that shows it, as large and with as many samples, as
 *  coarse and fine ones take turns. */
interface View {
  camera: MirroredCamera;
  targets: Map<WebGLRenderTarget, WebGLRenderTarget>;
}

/** `lookup(position, normal)`: light that arrives from where a mirror shows it, and Fresnel's factor. */
const reflectionGlsl = /* glsl */ `
uniform int source;
uniform sampler2D view;
uniform samplerCube probe;
uniform vec3 probeAt, boxLow, boxHigh, f0, f90;
uniform vec2 size;
vec3 fresnel(vec3 position, vec3 normal) {
  float away = 1.0 - clamp(abs(dot(normalize(cameraPosition - position), normalize(normal))), 0.0, 1.0);
  return f0 + (f90 - f0) * pow(away, 5.0);
}
vec3 lookup(vec3 position, vec3 normal) {
  if (source == ${Source.none}) return vec3(0.0);
  if (source == ${Source.view}) {
    // As MirroredCamera has it: flipped, pixel by pixel. At the mirror's rim some of a pixel's samples look past it, to
    // where nothing is drawn.
    vec4 seen = texelFetch(view, ivec2(size.x - gl_FragCoord.x, gl_FragCoord.y), 0);
    return seen.a > 0.0 ? seen.rgb / seen.a : vec3(0.0);
  }
  vec3 incident = position - cameraPosition, n = normalize(normal);
  vec3 r = reflect(normalize(incident), n);
  vec3 far = max((boxLow - position) / r, (boxHigh - position) / r);
  return texture(probe, position + r * min(far.x, min(far.y, far.z)) - probeAt).rgb;
}
`;

const glassVertex = /* glsl */ `
precision highp float;
uniform mat4 modelViewMatrix, projectionMatrix;
in vec3 position, normal;
out vec3 place, up;
void main() {
  place = position;
  up = normal;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}
`;

export class Speculars {
  readonly parts: Drawn[] = [];
  private readonly views: View[] = [];
  private readonly probes: Probe[] = [];
  private readonly shared: Record<'size' | 'boxLow' | 'boxHigh' | 'unit', IUniform>;
  private readonly diagonal: number;
  private readonly bases: Mesh[];
  /** Probes of lobes as they were are `old`. */
  private probing: 'missing' | 'old' | 'new' = 'missing';
  private numbers = false;

  /** Null if the scene has neither mirrors nor glass. */
  static of(solution: Solution, layout: Layout, surfaces: Surfaces, scene: Scene, box: Box3): Speculars | null {
    const diagonal = box.min.distanceTo(box.max);
    const parts = [...mirrorsOf(solution, layout, diagonal), ...glassOf(solution, diagonal)];
    return parts.length > 0 ? new Speculars(parts, solution, layout, surfaces, scene, box) : null;
  }

  private constructor(
    parts: SpecularPart[], solution: Solution, layout: Layout, private readonly surfaces: Surfaces, scene: Scene,
    private readonly box: Box3,
  ) {
    this.diagonal = box.min.distanceTo(box.max);
    surfaces.letMirrorsThrough(2 * kSlack * this.diagonal);
    this.shared = {
      size: { value: new Vector2() }, boxLow: { value: box.min }, boxHigh: { value: box.max }, unit: surfaces.uniforms.unit,
    };
    if (parts.some((p) => !p.plane && !p.glass)) surfaces.setAttribute('normal', normalsBySlot(layout));
    for (const part of parts) {
      const { f0, f90 } = solution.materials[part.material].specular;
      const probe = this.probeFor(part);
      const uniforms = {
        ...this.shared, f0: { value: new Vector3(...f0) }, f90: { value: new Vector3(...f90) },
        source: { value: Source.none }, view: { value: null }, probe: { value: null },
        probeAt: { value: probe.at },
      };
      const meshes = part.glass
        ? this.glassMeshes(part, passedAtSurface(part, solution.materials[part.material]), uniforms)
        : [this.mirrorMesh(part, uniforms)];
      for (const mesh of meshes) scene.add(mesh);
      this.parts.push({ part, meshes, uniforms, probe });
    }
    this.bases = [true, false].flatMap((flat) => this.glassBase(solution, layout, flat));
    for (const mesh of this.bases) scene.add(mesh);
  }

  /** Opaque ones, which have depths. */
  get mirrorGeometries(): BufferGeometry[] {
    return this.parts.filter((p) => !p.part.glass).map((p) => p.meshes[0].geometry);
  }

  /** Lobes look different from now on, so what was drawn of them does. */
  forget(): void {
    if (this.probing === 'new') this.probing = 'old';
  }

  /** In false colours mirrors show their own number, and glass is not there. */
  showNumbers(numbers: boolean): void {
    this.numbers = numbers;
    for (const { part, meshes } of this.parts) {
      for (const mesh of meshes) {
        if (part.glass) mesh.visible = !numbers;
        else mesh.material = numbers ? this.surfaces.numberMaterial() : (mesh.userData.mirror as RawShaderMaterial);
      }
    }
    for (const mesh of this.bases) mesh.visible = !numbers;
  }

  /**
   * Renders what `picture` will reflect. `beforeEye` makes ready what depends on where the eye is. Probes are many
   * pictures: they wait until the scene `stands`. Says whether they do not.
   */
  prepare(
    renderer: WebGLRenderer, scene: Scene, camera: PerspectiveCamera, picture: WebGLRenderTarget, stands: boolean,
    beforeEye: (eye: Vector3) => void,
  ): boolean {
    if (this.numbers) return true;
    if (this.probing === 'missing' || (this.probing === 'old' && stands)) this.renderProbes(renderer, scene, beforeEye);
    (this.shared.size.value as Vector2).set(picture.width, picture.height);
    for (const p of this.parts) {
      p.uniforms.source.value = Source.probe;
      p.uniforms.view.value = null;
    }

    const { box } = this, nowhere = new Vector4(0, 0, 0, 1e30);
    const backdrop = (this.surfaces.backdrop.material as RawShaderMaterial).uniforms;
    const mirrorPlane = backdrop.mirrorPlane?.value as Vector4 | undefined;
    const chosen = this.choose(camera);
    chosen.forEach(({ plane, parts }, i) => {
      const view = (this.views[i] ??= { camera: new MirroredCamera(), targets: new Map() });
      const { camera: mirrored } = view, target = targetOf(view, picture);
      const centre = box.getCenter(new Vector3());
      mirrored.reflect(camera, plane, kSlack * this.diagonal, (eye) => eye.distanceTo(centre) + this.diagonal);
      mirrorPlane?.set(plane.normal.x, plane.normal.y, plane.normal.z, plane.constant);
      for (const { meshes } of parts) for (const mesh of meshes) mesh.visible = false;
      const eye = new Vector3().setFromMatrixPosition(mirrored.matrixWorld);
      beforeEye(eye);
      this.sortFor(eye);
      renderer.setRenderTarget(target);
      renderer.clear();
      renderer.render(scene, mirrored);
      for (const { meshes } of parts) for (const mesh of meshes) mesh.visible = true;
    });
    mirrorPlane?.copy(nowhere);
    // Only now: in a view other planes show their probes.
    chosen.forEach(({ parts }, i) => {
      for (const { uniforms } of parts) {
        uniforms.source.value = Source.view;
        uniforms.view.value = targetOf(this.views[i], picture).texture;
      }
    });
    this.sortFor(new Vector3().setFromMatrixPosition(camera.matrixWorld));
    return this.probing === 'new';
  }

  /** The planes that look largest, turned to the eye. */
  private choose(camera: PerspectiveCamera): { plane: Plane; parts: Drawn[]; size: number }[] {
    const eye = new Vector3().setFromMatrixPosition(camera.matrixWorld);
    const frustum = new Frustum().setFromProjectionMatrix(
      new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse));
    const found: { plane: Plane; parts: Drawn[]; size: number }[] = [];
    for (const drawn of this.parts) {
      const { part } = drawn;
      if (!part.plane || !frustum.intersectsBox(part.box)) continue;
      let plane = part.plane;
      let height = plane.distanceToPoint(eye);
      if (height < 0 && part.glass) {
        plane = plane.clone().negate();
        height = -height;
      }
      if (height <= 1e-4 * this.diagonal) continue;
      // About the solid angle; what the eye stands before counts as very large.
      const distance = Math.max(part.box.distanceToPoint(eye), height);
      const size = (part.area * height) / distance ** 3;
      const same = found.find((f) => isSame(f.plane, plane, this.diagonal));
      if (same) {
        same.parts.push(drawn);
        same.size += size;
      } else {
        found.push({ plane, parts: [drawn], size });
      }
    }
    return found.sort((a, b) => b.size - a.size).slice(0, kMostViews);
  }

  /** From far to near; of one part in the order of its meshes. */
  private sortFor(eye: Vector3): void {
    const centre = new Vector3();
    const glass = this.parts.filter((p) => p.part.glass)
      .map((p) => ({ p, distance: p.part.box.getCenter(centre).distanceTo(eye) }))
      .sort((a, b) => b.distance - a.distance);
    glass.forEach(({ p }, i) => p.meshes.forEach((mesh, k) => (mesh.renderOrder = 10 * (i + 1) + k)));
  }

  private probeFor(part: SpecularPart): Probe {
    const at = part.box.getCenter(new Vector3());
    // Off the plane by a twentieth of the scene: a probe in it would see half of nothing.
    if (part.plane && !part.glass) at.addScaledVector(part.plane.normal, 0.05 * this.diagonal);
    if (this.probes.length < kMostProbes) {
      const target = new WebGLCubeRenderTarget(kProbePixels, {
        format: RGBAFormat, type: HalfFloatType, minFilter: LinearFilter, magFilter: LinearFilter,
      });
      this.probes.push({ at, target });
      return this.probes[this.probes.length - 1];
    }
    return this.probes.reduce((a, b) => (a.at.distanceTo(at) <= b.at.distanceTo(at) ? a : b));
  }

  /** Probes are taken without glass and without the backs of faces: a curved mirror's sits inside of it. */
  private renderProbes(renderer: WebGLRenderer, scene: Scene, beforeEye: (eye: Vector3) => void): void {
    this.probing = 'new';
    const backs = this.surfaces.backdrop.visible;
    const backdrop = (this.surfaces.backdrop.material as RawShaderMaterial).uniforms;
    const seeThrough = backdrop.seeThrough?.value as boolean | undefined;
    this.surfaces.seeThrough(true);
    for (const { part, meshes, uniforms } of this.parts) {
      uniforms.source.value = Source.none;
      uniforms.probe.value = null;
      if (part.glass) for (const mesh of meshes) mesh.visible = false;
    }
    for (const { at, target } of this.probes) {
      const cube = new CubeCamera(1e-3 * this.diagonal, 2 * this.diagonal, target);
      cube.position.copy(at);
      beforeEye(at);
      const clear = renderer.autoClear;
      renderer.autoClear = true;
      cube.update(renderer, scene);
      renderer.autoClear = clear;
    }
    for (const { part, meshes, uniforms, probe } of this.parts) {
      uniforms.probe.value = probe.target.texture;
      if (part.glass) for (const mesh of meshes) mesh.visible = true;
    }
    this.surfaces.seeThrough(seeThrough ?? !backs);
  }

  private mirrorMesh(part: SpecularPart, uniforms: Record<string, IUniform>): Mesh {
    const curved = !part.plane;
    const material = this.surfaces.patchMaterial(
      !isFlat(part.patches[0].patch),
      /* glsl */ `
      in vec3 place;
      ${curved ? 'in vec3 up;' : 'uniform vec3 up;'}
      ${reflectionGlsl}
      void main() {
        vec3 mirrored = fresnel(place, up) * lookup(place, up);
        pixel = vec4(min(stored(leaving()) + mirrored, ${kBrightest}.0), 1.0);
      }`,
      `out vec3 place;${curved ? ' in vec3 normal; out vec3 up;' : ''}`,
      `place = position;${curved ? ' up = normal;' : ''}`,
      part.plane ? { ...uniforms, up: { value: part.plane.normal } } : uniforms,
    );
    const mesh = asMesh(this.surfaces.geometry(elementsOf(part.patches)), material);
    mesh.userData.mirror = material;
    return mesh;
  }

  /** Far sides before near ones, and of each first what it takes, then what it adds. */
  private glassMeshes(part: SpecularPart, transmission: readonly number[], uniforms: Record<string, IUniform>): Mesh[] {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(part.glass!.positions, 3));
    geometry.setAttribute('normal', new BufferAttribute(part.glass!.normals, 3));
    const all = { ...uniforms, transmission: { value: new Vector3(...transmission) } };
    const pass = (side: Side, adds: boolean) => asMesh(geometry, new RawShaderMaterial({
      glslVersion: GLSL3, side, transparent: true, depthWrite: false, uniforms: all,
      blending: CustomBlending, blendEquation: AddEquation,
      blendSrc: adds ? OneFactor : DstColorFactor, blendDst: adds ? OneFactor : ZeroFactor,
      blendSrcAlpha: ZeroFactor, blendDstAlpha: OneFactor,
      vertexShader: glassVertex,
      fragmentShader: /* glsl */ `
        precision highp float;
        precision highp int;
        in vec3 place, up;
        uniform vec3 cameraPosition, transmission;
        out vec4 pixel;
        ${reflectionGlsl}
        void main() {
          vec3 F = fresnel(place, up);
          pixel = vec4(${adds ? 'F * lookup(place, gl_FrontFacing ? up : -up)' : 'transmission * (1.0 - F)'}, 1.0);
        }`,
    }));
    const sides: Side[] = part.plane ? [DoubleSide] : [BackSide, FrontSide];
    // Inside a body the reflection is another's business: light goes around in it.
    return sides.flatMap((side) => (side === BackSide ? [pass(side, false)] : [pass(side, false), pass(side, true)]));
  }

  /** What glass reflects by itself, under its coat: it is added to what is seen through it. */
  private glassBase(solution: Solution, layout: Layout, flat: boolean): Mesh[] {
    const placed = layout.patches.filter(
      ({ patch }) => solution.materials[patch.material].transmission && isFlat(patch) === flat);
    if (placed.length === 0) return [];
    const material = this.surfaces.patchMaterial(!flat, plainMain);
    material.transparent = true;
    material.depthWrite = false;
    material.blending = CustomBlending;
    material.blendSrc = material.blendDst = OneFactor;
    const mesh = asMesh(this.surfaces.geometry(elementsOf(placed)), material);
    mesh.renderOrder = 1e6;
    return [mesh];
  }
}

/** The share of light that one surface of a piece of glass lets go on, but for Fresnel's factor. */
function passedAtSurface({ area, volume }: SpecularPart, { transmission, extinction }: Material): Rgb {
  const meanChord = (4 * volume) / area;  // of a convex body: Cauchy
  return transmission!.map((t, c) => t * Math.exp((-extinction[c] * meanChord) / 2)) as Rgb;
}

function targetOf({ targets }: View, picture: WebGLRenderTarget): WebGLRenderTarget {
  let target = targets.get(picture);
  if (!target) targets.set(picture, (target = picture.clone()));
  target.setSize(picture.width, picture.height);
  return target;
}

function normalsBySlot(layout: Layout): BufferAttribute {
  const normals = new Float32Array(3 * layout.nodeCount);
  for (const { patch, firstSlot } of layout.patches) normals.set(patch.normals, 3 * firstSlot);
  return new BufferAttribute(normals, 3);
}
