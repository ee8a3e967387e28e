/**
 * How long a frame takes, waiting for the GPU (in software: SwiftShader), and what the solution takes there:
 *
 *     node bench/frames.mjs SOLUTION.glb... [--size 1200x800] [--frames 9] [--precision half|float]
 *
 * Milliseconds are medians. "frame": the camera has moved; "same eye": only exposure has changed, so that no lobe is
 * evaluated; their difference is what lobes cost. Bytes are those sent as textures and buffers before the first frame.
 */
import { parseArgs } from 'node:util';
import { openPage } from './browser.mjs';

const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: { size: { type: 'string', default: '1200x800' }, frames: { type: 'string', default: '9' },
             precision: { type: 'string', default: 'half' } },
});
const [width, height] = values.size.split('x').map(Number);
for (const file of positionals) {
  const { page, messages, close } = await openPage(file, { width, height });
  const result = await page.evaluate(async ({ frames, precision }) => {
    const { stage, solution, Picture } = window;
    const canvas = Object.assign(document.createElement('canvas'), { width: 1, height: 1 });
    const picture = precision === 'half' ? stage.picture : new Picture(canvas, solution, () => {}, precision);
    if (picture !== stage.picture) picture.resize(innerWidth, innerHeight, 1);
    const gl = (picture === stage.picture ? stage.canvas : canvas).getContext('webgl2');
    const time = (change) => {
      const all = [];
      for (let i = -2; i < frames; ++i) {
        change(i);
        const start = performance.now();
        picture.draw(stage.camera, stage.settings, null);
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
        if (i >= 0) all.push(performance.now() - start);
      }
      return all.sort((a, b) => a - b)[Math.floor(all.length / 2)];
    };
    const bytes = picture.stats.uploadedBytes;
    const frame = time((i) => { stage.camera.position.x += 1e-3 * i; stage.camera.updateMatrixWorld(); });
    const moved = picture.stats.uploadedBytes;
    time((i) => { stage.camera.position.x += 1e-3 * i; stage.camera.updateMatrixWorld(); });
    const still = time((i) => stage.set({ exposure: 0.01 * i }));
    return {
      nodes: solution.nodeCount, glossy: solution.patches.reduce((n, p) => n + (p.lobes?.lMax > 0 ? p.positions.length / 3 : 0), 0),
      elements: solution.elementCount, frame: +frame.toFixed(1), sameEye: +still.toFixed(1),
      bytes: picture.stats.uploadedBytes, bytesPerNode: +(picture.stats.uploadedBytes / solution.nodeCount).toFixed(1),
      uploadedWhileMoving: picture.stats.uploadedBytes - moved, drawCalls: picture.stats.drawCalls, before: bytes,
    };
  }, { frames: Number(values.frames), precision: values.precision });
  console.log(file.split('/').pop(), values.precision, JSON.stringify(result));
  for (const m of messages.filter((m) => !/404|GPU stall/.test(m)).slice(0, 5)) console.log('  ', m);
  await close();
}
