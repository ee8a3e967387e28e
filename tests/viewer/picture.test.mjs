import assert from 'node:assert/strict';
import path from 'node:path';
import { test } from 'node:test';
import { lobe, solution, view, work } from './support/lobe.mjs';
import { capture, withScene } from './support/page.mjs';
import { difference, keep, nearJumps, readPng } from './support/pictures.mjs';

const kSize = [480, 320];

for (const scene of ['cornell_glossy', 'glossy_floor']) {
  for (const camera of ['view0', 'view1']) {
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
          const { byChannel, share } = difference(expected, shown, nearJumps(expected));
          const words = `${byChannel.map((d) => d.toFixed(2))} of 255 over ${(100 * share).toFixed(0)} % of the pixels; ` +
            `see ${picture} and ${kept}`;
          console.log(`${scene} ${camera}: ${words}`);
          assert.ok(share > 0.6, `too little is compared: ${words}`);
          for (const d of byChannel) assert.ok(d < 2, words);
          // Everything, edges too: a shift by a pixel would show here.
          for (const d of difference(expected, shown).byChannel) assert.ok(d < 5, `with edges ${d} of 255; ${words}`);
        });
      } finally {
        await site.close();
      }
    });
  }
}
