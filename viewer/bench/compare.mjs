/**
 * How far the viewer's pictures are from those of `lobe render --mode stored`, and where:
 *
 *     node bench/compare.mjs SOLUTION.glb CAMERA REFERENCE.png OUT.png ['settings as JSON']
 *
 * CAMERA is a number from 0. Differences are of 255, per channel, away from edges: pixels within 2 of where the
 * reference changes by more than 12 between neighbours are left out. OUT.png is the viewer's picture.
 */
import { readFile, writeFile } from 'node:fs/promises';
import { openPage } from './browser.mjs';

const [solution, camera, reference, out, settings] = process.argv.slice(2);
const { page, messages, close } = await openPage(solution);
const png = reference === '-' ? null : (await readFile(reference)).toString('base64');
const result = await page.evaluate(
  async ({ camera, png, settings }) => {
    const { stage, look } = window;
    look(camera);
    stage.set(JSON.parse(settings));
    const image = png && (await createImageBitmap(await (await fetch(`data:image/png;base64,${png}`)).blob()));
    const width = image?.width ?? 400, height = image?.height ?? 400;
    const { pixels } = stage.capture(width, height);
    const canvas = new OffscreenCanvas(width, height), context = canvas.getContext('2d', { willReadFrequently: true });
    let difference = null;
    if (image) {
      context.drawImage(image, 0, 0);
      const { data } = context.getImageData(0, 0, width, height);
      const edge = new Uint8Array(width * height);
      const far = (i, j) => [0, 1, 2].some((c) => Math.abs(data[4 * i + c] - data[4 * j + c]) > 12);
      const mark = (x, y) => {
        for (let v = Math.max(0, y - 2); v <= Math.min(height - 1, y + 2); ++v) {
          edge.fill(1, v * width + Math.max(0, x - 2), v * width + Math.min(width - 1, x + 2) + 1);
        }
      };
      for (let y = 0; y < height; ++y) {
        for (let x = 0; x < width; ++x) {
          const i = y * width + x;
          if ((x + 1 < width && far(i, i + 1)) || (y + 1 < height && far(i, i + width))) mark(x, y);
        }
      }
      const all = [0, 0, 0], kept = [0, 0, 0], signed = [0, 0, 0], sizes = [];
      for (let i = 0; i < edge.length; ++i) {
        for (let c = 0; c < 3; ++c) {
          const d = pixels[4 * i + c] - data[4 * i + c];
          all[c] += Math.abs(d) / edge.length;
          if (edge[i]) continue;
          kept[c] += Math.abs(d);
          signed[c] += d;
          sizes.push(Math.abs(d));
        }
      }
      const n = sizes.length / 3;
      sizes.sort((a, b) => a - b);
      const round = (v) => v.map((x) => Math.round(1000 * x) / 1000);
      difference = {
        mean: round(kept.map((v) => v / n)), signed: round(signed.map((v) => v / n)),
        p99: sizes[Math.floor(0.99 * sizes.length)], most: sizes.at(-1), kept: round([n / edge.length])[0], withEdges: round(all),
      };
    }
    context.putImageData(new ImageData(pixels, width, height), 0, 0);
    const blob = await canvas.convertToBlob();
    return { difference, png: btoa(Array.from(new Uint8Array(await blob.arrayBuffer()), (b) => String.fromCharCode(b)).join('')) };
  },
  { camera: Number(camera), png, settings: settings ?? '{}' },
).catch(async (error) => ({ error }));
if (result.error) console.log(result.error, messages);
else {
  await writeFile(out, Buffer.from(result.png, 'base64'));
  console.log(solution.split('/').pop(), camera, JSON.stringify(result.difference));
}
for (const m of messages.filter((m) => !/404|GPU stall/.test(m)).slice(0, 5)) console.log('  ', m);
await close();
