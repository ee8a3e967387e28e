import assert from 'node:assert/strict';
import path from 'node:path';
import { test } from 'node:test';
import { lobe, solution, view, work } from './support/lobe.mjs';
import { capture, withScene } from './support/page.mjs';
import { difference, keep, nearJumps, readPng } from './support/pictures.mjs';

const kSize = [480, 320];

/**
 * The most by which pictures may differ away from jumps: mean by channel, of 255, and share of pixels off by more than
 * 16. Chosen, twice or more what was measured: 0.06 and 0 % of the room; of the hall, whose glossy floor has elements of
 * 0.8 m right before the eye, 0.24 and 0 %, and 0.74 and 1.1 %, as the page looks at an element's nodes each from the
 * eye.
 */
const views = [
  ['cornell_glossy', 'view0', 0.3, 0.001],
  ['cornell_glossy', 'view1', 0.3, 0.001],
  ['glossy_floor', 'view0', 0.6, 0.002],
  ['glossy_floor', 'view1', 1.5, 0.022],
];

for (const [scene, camera, mostMean, mostFar] of views) {
  test(`The page shows ${scene} from ${camera} as lobe render does`, async () => {
    const file = solution(scene), picture = path.join(work, `${scene}.${camera}.render.png`);
    lobe('render', file, '--mode', 'stored', '--camera', camera, '--size', kSize.join('x'), '-o', picture, '--quiet');
    const expected = readPng(picture);
    const site = await view(file);
    try {
      await withScene(`${site.address}#camera=${camera}`, async (page) => {
        await page.evaluate(() => window.lobe.stage.set({ exposure: 0, curve: 'srgb', degree: 64 }));
        const shown = await capture(page, ...kSize);
        const kept = keep(`${scene}.${camera}.page`, shown);
        const { byChannel, share, far } = difference(expected, shown, nearJumps(expected));
        const words = `${byChannel.map((d) => d.toFixed(2))} of 255 over ${(100 * share).toFixed(0)} % of the pixels, ` +
          `${(100 * far).toFixed(2)} % of them off by more than 16; see ${picture} and ${kept}`;
        console.log(`${scene} ${camera}: ${words}`);
        assert.ok(share > 0.6, `too little is compared: ${words}`);
        for (const d of byChannel) assert.ok(d < mostMean, words);
        assert.ok(far < mostFar, words);
        // Everything, edges too: a shift by a pixel would show here.
        for (const d of difference(expected, shown).byChannel) assert.ok(d < 5, `with edges ${d} of 255; ${words}`);
      });
    } finally {
      await site.close();
    }
  });
}
