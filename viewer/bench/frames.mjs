/**
 * How long a frame takes, waiting for the GPU (in software: SwiftShader), and what the solution takes there:
 *
 *     node bench/frames.mjs SOLUTION.glb... [--size 1200x800] [--frames 9] [--precision half|float]
 *
 * "moved": the camera has; "coarse": it has, and the picture is drawn as where frames come late (stage/pace.ts); "still": it
 * has not, so that no lobe is evaluated; its difference to "moved" is what lobes cost. `ms` is a median,
 * `processorMs` the mean processor time of all the browser's processes, which a busy machine inflates less. Bytes are
 * those sent as textures and buffers.
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
  const { page, messages, processorMs, close } = await openPage(file, { width, height });
  await page.evaluate((precision) => {
    const { stage, solution, Picture } = window;
    if (precision === 'half') {
      window.picture = stage.picture;
      window.gl = stage.canvas.getContext('webgl2');
    } else {
      const canvas = document.createElement('canvas');
      window.picture = new Picture(canvas, solution, () => {}, precision);
      window.picture.resize(innerWidth, innerHeight, 1);
      window.gl = canvas.getContext('webgl2');
    }
    window.run = (frames, step, coarsely) => {
      const { picture, stage, gl } = window, uploaded = picture.stats.uploadedBytes, times = [];
      for (let i = 0; i < frames; ++i) {
        stage.camera.position.x += step;
        const start = performance.now();
        picture.draw(stage.camera, stage.settings, null, coarsely);
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
        times.push(performance.now() - start);
      }
      times.sort((a, b) => a - b);
      return { ms: Math.round(times[frames >> 1]), uploaded: picture.stats.uploadedBytes - uploaded };
    };
    window.run(2, 1e-3, false);
    window.run(2, 1e-3, true);
  }, values.precision);
  const measure = async (step, coarsely = false) => {
    const before = processorMs();
    const result = await page.evaluate(([frames, step, coarsely]) => window.run(frames, step, coarsely),
      [Number(values.frames), step, coarsely]);
    return { ...result, processorMs: Math.round((processorMs() - before) / Number(values.frames)) };
  };
  const moved = await measure(1e-3), coarse = await measure(1e-3, true), still = await measure(0);
  const scene = await page.evaluate(() => {
    const { solution, picture } = window;
    return {
      nodes: solution.nodeCount, elements: solution.elementCount,
      glossy: solution.patches.reduce((n, p) => n + (p.lobes?.lMax > 0 ? p.positions.length / 3 : 0), 0),
      drawCalls: picture.stats.drawCalls, bytesANode: Math.round(picture.stats.uploadedBytes / solution.nodeCount),
    };
  });
  console.log(file.split('/').pop(), values.precision, JSON.stringify({ ...scene, moved, coarse, still }));
  for (const m of messages.filter((m) => !/404|GPU stall/.test(m)).slice(0, 5)) console.log('  ', m);
  await close();
}
