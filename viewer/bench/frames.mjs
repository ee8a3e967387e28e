/**
 * How long a frame takes, waiting for the GPU (in software: SwiftShader), and what the solution takes there:
 *
 *     node bench/frames.mjs SOLUTION.glb... [--size 1200x800] [--frames 9] [--precision half|float]
 *
 * "moved": the camera has; "coarse": it has, and the picture is drawn as where frames come late (stage/pace.ts);
 * "still": it has not, so that no lobe is evaluated; its difference to "moved" is what lobes cost. `ms` is a median,
 * `processorMs` the mean processor time of all the browser's processes, which a busy machine inflates less. Bytes are
 * those sent as textures and buffers.
 */
import { readFileSync, readdirSync } from 'node:fs';
import path from 'node:path';
import { parseArgs } from 'node:util';
import { closeBrowser } from '../../tests/viewer/support/page.mjs';
import { withStage } from './stage.mjs';

const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: { size: { type: 'string', default: '1200x800' }, frames: { type: 'string', default: '9' },
             precision: { type: 'string', default: 'half' } },
});
const [width, height] = values.size.split('x').map(Number);
const frames = Number(values.frames);

/** Processor time that this process' descendants have used: the browser's (Linux). */
function processorMs() {
  const stats = readdirSync('/proc').filter((name) => /^\d+$/.test(name)).flatMap((pid) => {
    try {
      const text = readFileSync(`/proc/${pid}/stat`, 'latin1');
      const fields = text.slice(text.lastIndexOf(')') + 2).split(' ');
      return [{ pid: Number(pid), parent: Number(fields[1]), ticks: Number(fields[11]) + Number(fields[12]) }];
    } catch {
      return [];
    }
  });
  const family = new Set([process.pid]);
  for (let before = 0; before < family.size; ) {
    before = family.size;
    for (const { pid, parent } of stats) if (family.has(parent)) family.add(pid);
  }
  family.delete(process.pid);
  return 10 * stats.filter(({ pid }) => family.has(pid)).reduce((sum, { ticks }) => sum + ticks, 0);
}

/** In the page: puts there what draws and waits. */
function prepare(precision) {
  const { lobe } = window, { stage, solution, Picture } = lobe;
  if (precision === 'half') {
    lobe.picture = stage.picture;
    lobe.gl = stage.canvas.getContext('webgl2');
  } else {
    const canvas = document.createElement('canvas');
    lobe.picture = new Picture(canvas, solution, () => {}, precision);
    lobe.picture.resize(innerWidth, innerHeight, 1);
    lobe.gl = canvas.getContext('webgl2');
  }
  lobe.run = ([frames, step, coarsely]) => {
    const { picture, gl } = lobe, uploaded = picture.stats.uploadedBytes, times = [];
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
  lobe.run([2, 1e-3, false]);
  lobe.run([2, 1e-3, true]);
}

/** In the page: what is drawn. */
function describe() {
  const { solution, picture } = window.lobe;
  return {
    nodes: solution.nodeCount, elements: solution.elementCount,
    glossy: solution.patches.reduce((n, p) => n + (p.lobes?.lMax > 0 ? p.positions.length / 3 : 0), 0),
    drawCalls: picture.stats.drawCalls, bytesANode: Math.round(picture.stats.uploadedBytes / solution.nodeCount),
  };
}

async function measure(page, step, coarsely) {
  const before = processorMs();
  const result = await page.evaluate((how) => window.lobe.run(how), [frames, step, coarsely]);
  return { ...result, processorMs: Math.round((processorMs() - before) / frames) };
}

try {
  for (const file of positionals) {
    await withStage(file, async (page) => {
      await page.evaluate(prepare, values.precision);
      const moved = await measure(page, 1e-3, false), coarse = await measure(page, 1e-3, true);
      const still = await measure(page, 0, false), scene = await page.evaluate(describe);
      console.log(path.basename(file), values.precision, JSON.stringify({ ...scene, moved, coarse, still }));
    }, { width, height });
  }
} finally {
  await closeBrowser();
}
