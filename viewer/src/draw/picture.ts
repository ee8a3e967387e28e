import {
  Color, HalfFloatType, LinearFilter, NearestFilter, RGBAFormat, Sphere, Vector2, WebGLRenderer, WebGLRenderTarget,
  type Group, type PerspectiveCamera,
} from 'three';
import { boundsOf } from '../solution/bounds';
import { Problem } from '../solution/problem';
import type { Solution } from '../solution/solution';
import type { Quantity, Settings } from './settings';
import type { Precision } from './lobe_textures';
import { percentiles, valuesOf } from './quantities';
import { Resident } from './resident';
import { meterUploads } from './upload_meter';

const kSamples = 4;
/** Coarse pictures have so many pixels for one, along each side, and one sample in each. */
const kCoarse = 0.5;

export interface DrawStats {
  frames: number;
  /** Of the last frame, milliseconds, waiting for the GPU only where the browser does. */
  frameMs: number;
  /** Bytes sent to the GPU as textures and buffers since the page was opened. */
  uploadedBytes: number;
  /** Of the last frame: mirrors' and probes' included. */
  drawCalls: number;
  triangles: number;
}

/** A picture as bytes: RGBA, top row first. */
export interface Captured {
  width: number;
  height: number;
  pixels: Uint8ClampedArray;
}

/**
 * Draws a solution from anywhere. A frame is: the light of glossy nodes towards the eye (NodeLight); the scene in
 * linear light, in half floats with four samples a pixel (Surfaces, Speculars); exposure and curve, on to the canvas
 * (Tone); over it, hidden by what is before it, the overlay. All that this needs on the GPU is sent before the first
 * frame.
 */
export class Picture {
  readonly stats: DrawStats = { frames: 0, frameMs: 0, uploadedBytes: 0, drawCalls: 0, triangles: 0 };
  private readonly gl: WebGL2RenderingContext;
  private readonly renderer: WebGLRenderer;
  /** All that the GPU holds. */
  private held: { resident: Resident; fine: WebGLRenderTarget; coarse: WebGLRenderTarget };
  private readonly sphere = new Sphere();
  private readonly values = new Map<Quantity, Float32Array>();
  private lost = false;

  /** Throws Problem where the browser cannot draw. `onRestored` is called when a GPU that had forgotten everything has
   *  it again. */
  constructor(
    canvas: HTMLCanvasElement, private readonly solution: Solution, onRestored: () => void = () => {},
    precision: Precision = 'half',
  ) {
    const gl = canvas.getContext('webgl2', {
      alpha: false, antialias: true, preserveDrawingBuffer: true, powerPreference: 'high-performance',
    });
    if (!gl) throw new Problem('This browser offers no WebGL 2, which the viewer draws with; perhaps it is switched off.');
    const floats = gl.getExtension('EXT_color_buffer_float') !== null;
    if (!floats && !gl.getExtension('EXT_color_buffer_half_float')) {
      throw new Problem('This browser’s WebGL cannot draw into half floats, in which the viewer adds up light.');
    }
    this.gl = gl;
    meterUploads(gl, (bytes) => (this.stats.uploadedBytes += bytes));
    this.renderer = new WebGLRenderer({ canvas, context: gl });
    this.renderer.autoClear = false;
    this.renderer.info.autoReset = false;
    const light = { format: RGBAFormat, type: HalfFloatType, minFilter: NearestFilter } as const;
    const samples = Math.min(kSamples, gl.getParameter(gl.MAX_SAMPLES) as number);
    const limits = {
      side: gl.getParameter(gl.MAX_TEXTURE_SIZE) as number, layers: gl.getParameter(gl.MAX_ARRAY_TEXTURE_LAYERS) as number,
    };
    const box = boundsOf(solution);
    box.getBoundingSphere(this.sphere);
    const build = () => {
      this.renderer.setClearColor(new Color(0), 0);
      return {
        resident: new Resident(this.renderer, solution, box, floats, precision, limits, (q) => this.numbers(q)),
        fine: new WebGLRenderTarget(1, 1, { ...light, magFilter: NearestFilter, samples }),
        coarse: new WebGLRenderTarget(1, 1, { ...light, magFilter: LinearFilter }),
      };
    };
    this.held = build();
    canvas.addEventListener('webglcontextlost', () => (this.lost = true));
    canvas.addEventListener('webglcontextrestored', () => {
      // three has begun anew by now, and what the GPU held is gone. It is kept nowhere else: it is made again.
      this.lost = false;
      this.held = build();
      onRestored();
    });
  }

  /** One number a node; computed at its first use. */
  numbers(quantity: Quantity): Float32Array {
    let found = this.values.get(quantity);
    if (!found) this.values.set(quantity, (found = valuesOf(this.solution, quantity)));
    return found;
  }

  range(quantity: Quantity): { low: number; high: number } {
    const values = this.numbers(quantity);
    // Diffuse nodes have no negative part, and would be most of them.
    return percentiles(quantity === 'negative' ? values.filter((v) => v > 0) : values);
  }

  resize(width: number, height: number, pixelRatio: number): void {
    this.renderer.setPixelRatio(pixelRatio);
    this.renderer.setSize(width, height, false);
  }

  /** Says whether the picture is all that it can be: not if it is coarse, nor, unless it `stands`, as long as probes
   *  of mirrors show lobes of a degree before. */
  draw(
    camera: PerspectiveCamera, settings: Readonly<Settings>, overlay: Group | null, coarsely = false, stands = !coarsely,
  ): boolean {
    if (this.lost) return true;
    const start = performance.now();
    this.renderer.info.reset();
    this.fitDepth(camera);
    camera.updateMatrixWorld();
    const size = this.renderer.getDrawingBufferSize(new Vector2());
    const { resident, fine, coarse } = this.held;
    const target = coarsely ? coarse : fine, scale = coarsely ? kCoarse : 1;
    target.setSize(Math.ceil(size.x * scale), Math.ceil(size.y * scale));
    const whole = resident.draw(camera, settings, target, stands);
    this.renderer.setRenderTarget(null);
    resident.show(target, settings, size);
    const some = overlay?.visible && overlay.children.some((child) => child.visible);
    resident.drawOver(camera, settings, some ? overlay : null);
    ++this.stats.frames;
    this.stats.frameMs = performance.now() - start;
    this.stats.drawCalls = this.renderer.info.render.calls;
    this.stats.triangles = this.renderer.info.render.triangles;
    return whole && !coarsely;
  }

  /** What a canvas of that size would show, read back. The canvas is as before, but has to be drawn again. */
  capture(
    camera: PerspectiveCamera, settings: Readonly<Settings>, overlay: Group | null, width: number, height: number,
  ): Captured {
    if (this.lost) throw new Problem('The graphics card has let go of this page; it draws again once the browser has got it back.');
    const most = Math.min(this.gl.getParameter(this.gl.MAX_RENDERBUFFER_SIZE) as number, 16384);
    if (![width, height].every((side) => Number.isInteger(side) && side >= 1 && side <= most)) {
      throw new Problem(`A picture of ${width} x ${height} pixels was asked for; here each side can have 1 to ${most}, whole ones.`);
    }
    const { renderer, gl } = this;
    const size = renderer.getSize(new Vector2()), ratio = renderer.getPixelRatio();
    const { frames, frameMs } = this.stats;
    const eye = camera.clone();
    eye.aspect = width / height;
    eye.updateProjectionMatrix();
    try {
      this.resize(width, height, 1);
      this.draw(eye, settings, overlay);
      const rows = new Uint8ClampedArray(4 * width * height), pixels = new Uint8ClampedArray(rows.length);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(rows.buffer));
      for (let y = 0; y < height; ++y) {
        pixels.set(rows.subarray(4 * width * y, 4 * width * (y + 1)), 4 * width * (height - 1 - y));
      }
      return { width, height, pixels };
    } finally {
      this.resize(size.x, size.y, ratio);
      Object.assign(this.stats, { frames, frameMs });
    }
  }

  /** Near and far planes that hold the scene and what may stand out of it a little. */
  private fitDepth(camera: PerspectiveCamera): void {
    const { center, radius } = this.sphere;
    const distance = camera.position.distanceTo(center);
    const near = Math.max(1e-3 * radius, 0.5 * (distance - 1.5 * radius)), far = distance + 1.5 * radius;
    if (Math.abs(camera.near / near - 1) < 1e-3 && Math.abs(camera.far / far - 1) < 1e-3) return;
    camera.near = near;
    camera.far = far;
    camera.updateProjectionMatrix();
  }
}
