import { Mesh, Scene, Vector3, type Vector2, type Box3, type PerspectiveCamera, type WebGLRenderer, type WebGLRenderTarget } from 'three';
import type { Solution } from '../solution/solution';
import type { Settings } from './settings';
import { bySlot, layOut, type Layout } from './layout';
import { checkRoom, LobeTextures, type Precision, type TextureLimits } from './lobe_textures';
import { NodeLight } from './node_light';
import { Speculars } from './speculars';
import { asMesh, Surfaces } from './surfaces';
import { Tone, type Content } from './tone';

/** All of a solution that the GPU holds, and the passes over it. */
export class Resident {
  private readonly tone: Tone;
  private readonly scene = new Scene();
  /** Depths alone, and what is drawn over the picture. */
  private readonly over = new Scene();
  private readonly layout: Layout;
  private readonly lobes: LobeTextures;
  private readonly nodeLight: NodeLight;
  private readonly surfaces: Surfaces;
  private readonly speculars: Speculars | null;
  private shown: Settings | null = null;
  private content: Content = 'light';

  constructor(
    private readonly renderer: WebGLRenderer, solution: Solution, box: Box3, floats: boolean, precision: Precision,
    limits: TextureLimits,
    /** One number a node of the whole solution. */
    private readonly valuesOf: (quantity: NonNullable<Settings['falseColour']>['quantity']) => Float32Array,
  ) {
    this.layout = layOut(solution);
    checkRoom(this.layout, limits);
    this.lobes = new LobeTextures(solution, this.layout, precision);
    this.nodeLight = new NodeLight(this.layout, this.lobes, floats);
    const { coefficients, coefficientUnit } = this.lobes.uniforms;
    const opaque = this.layout.patches.filter(({ patch }) => {
      const material = solution.materials[patch.material];
      return material.kind !== 'mirror' && !material.transmission;
    });
    const unit = solution.exposureScale > 0 ? solution.exposureScale : 1;
    this.surfaces = new Surfaces(
      solution, this.layout, { coefficients, coefficientUnit }, this.nodeLight.target.textures, unit, opaque);
    this.scene.add(...this.surfaces.patches, this.surfaces.backdrop);
    this.speculars = Speculars.of(solution, this.layout, this.surfaces, this.scene, box);
    this.tone = new Tone(unit);
    const depth = this.surfaces.depths[1].material as never;
    for (const geometry of this.speculars?.mirrorGeometries ?? []) this.over.add(asMesh(geometry, depth));
    this.over.add(...this.surfaces.depths);
    for (const mesh of this.over.children) (mesh as Mesh).renderOrder = -1e9;
  }

  /** Whatever of the settings reaches further than the tone pass. */
  private apply(settings: Readonly<Settings>): void {
    const before = this.shown;
    if (before === settings) return;
    this.shown = settings;
    if (before?.degree !== settings.degree) {
      this.lobes.uniforms.degree.value = settings.degree;
      this.speculars?.forget();
    }
    if (before?.seeThroughBacks !== settings.seeThroughBacks) this.surfaces.seeThrough(settings.seeThroughBacks);
    const colour = settings.falseColour;
    this.content = !colour ? 'light' : colour.quantity === 'radiance' ? 'radiance' : 'colours';
    const quantity = this.content === 'colours' ? colour!.quantity : null;
    if (colour && quantity) this.surfaces.setScale(quantity, colour.low, colour.high, colour.logarithmic);
    const was = before?.falseColour?.quantity ?? null;
    if (quantity !== (was === 'radiance' ? null : was)) {
      this.surfaces.showNumbers(quantity ? bySlot(this.layout, this.valuesOf(quantity)) : null);
      this.speculars?.showNumbers(quantity !== null);
    }
  }

  /** The scene, in linear light. Says whether probes show it as it is now; while it `stands`, they do. */
  draw(camera: PerspectiveCamera, settings: Readonly<Settings>, target: WebGLRenderTarget, stands: boolean): boolean {
    this.apply(settings);
    const { renderer } = this;
    const evaluate = (eye: Vector3) => this.nodeLight.evaluate(renderer, eye);
    const whole = this.speculars?.prepare(renderer, this.scene, camera, target, stands, evaluate) ?? true;
    evaluate(new Vector3().setFromMatrixPosition(camera.matrixWorld));
    renderer.setRenderTarget(target);
    renderer.clear();
    renderer.render(this.scene, camera);
    return whole;
  }

  /** From `target` to the render target that is set, of `size` pixels. */
  show(target: WebGLRenderTarget, settings: Readonly<Settings>, size: Vector2): void {
    this.tone.draw(this.renderer, target.texture, this.content, settings, size);
  }

  /** Over the picture: the scene's depth once more, without colours, and what it may hide. */
  drawOver(camera: PerspectiveCamera, settings: Readonly<Settings>, overlay: Scene['children'][number] | null): void {
    const wires = settings.wireframe ? this.surfaces.wires() : null;
    if (!wires && !overlay) return;
    if (wires) this.over.add(wires);
    if (overlay) this.over.add(overlay);
    this.renderer.clearDepth();
    this.renderer.render(this.over, camera);
    if (wires) this.over.remove(wires);
    if (overlay) this.over.remove(overlay);
  }
}
