import {
  BufferAttribute, BufferGeometry, Color, Mesh, MeshBasicMaterial, Scene, WebGLRenderer, type Group,
  type PerspectiveCamera,
} from 'three';
import type { Solution } from '../solution/solution';
import type { Settings } from '../stage/settings';
import type { StageStats } from '../stage/stage';

/** Draws a solution from anywhere. */
export class Picture {
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  readonly stats: StageStats = { frames: 0, frameMs: 0, uploadedBytes: 0 };

  constructor(canvas: HTMLCanvasElement, solution: Solution) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.scene.background = new Color(0);
    const material = new MeshBasicMaterial({ vertexColors: true });
    for (const patch of solution.patches) {
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', new BufferAttribute(patch.positions, 3));
      geometry.setAttribute('color', new BufferAttribute(patch.baked, 3));
      geometry.setIndex(new BufferAttribute(patch.indices, 1));
      this.scene.add(new Mesh(geometry, material));
    }
  }

  resize(width: number, height: number, pixelRatio: number): void {
    this.renderer.setPixelRatio(pixelRatio);
    this.renderer.setSize(width, height, false);
  }

  draw(camera: PerspectiveCamera, _settings: Settings, overlay: Group): void {
    const start = performance.now();
    this.scene.add(overlay);
    this.renderer.render(this.scene, camera);
    ++this.stats.frames;
    this.stats.frameMs = performance.now() - start;
  }
}
