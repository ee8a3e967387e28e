import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { test } from 'node:test';
import { changeGlb } from './support/glb.mjs';
import { keep, lobe, scene, solution, view, work } from './support/lobe.mjs';
import { capture, withScene } from './support/page.mjs';
import { difference, nearJumps, readPng } from './support/pictures.mjs';

const kSize = [480, 320];

/**
 * The most by which pictures may differ away from jumps: mean by channel, of 255, and share of pixels off by more than
 * 16. Half as much again as was measured: 0.03, 0.06, 0.24, 0.74 and 0.03, and 1.1 % of the hall's view1, which looks at
 * a glossy floor with elements of 0.8 m right before the eye, where slopes at the nodes (draw/node_light.ts) leave the
 * most.
 */
const views = [
  ['cornell_glossy', 'view0', 0.05, 0.0005],
  ['cornell_glossy', 'view1', 0.09, 0.0005],
  ['glossy_floor', 'view0', 0.36, 0.0005],
  ['glossy_floor', 'view1', 1.1, 0.016],
  ['mirror_room', 'view0', 0.05, 0.0005],
];

/** The room with a wall of polished metal. */
function mirrorRoom() {
  const file = path.join(work, 'mirror_room.glb');
  writeFileSync(file, changeGlb(readFileSync(scene('cornell_glossy')), ({ materials }) => {
    const wall = materials.find(({ name }) => name === 'glossy back wall');
    wall.pbrMetallicRoughness = { baseColorFactor: [0.95, 0.9, 0.85, 1], metallicFactor: 1, roughnessFactor: 0 };
    delete wall.extensions;
  }));
  return file;
}

for (const [name, camera, mostMean, mostFar] of views) {
  test(`The page shows ${name} from ${camera} as lobe render does`, async () => {
    const file = name === 'mirror_room' ? solution(name, mirrorRoom()) : solution(name);
    const picture = path.join(work, `${name}.${camera}.render.png`);
    lobe('render', file, '--mode', 'stored', '--camera', camera, '--size', kSize.join('x'), '-o', picture, '--quiet');
    const expected = readPng(picture);
    const site = await view(file);
    try {
      await withScene(`${site.address}#camera=${camera}`, async (page) => {
        await page.evaluate(() => window.lobe.stage.set({ exposure: 0, curve: 'srgb', degree: 64 }));
        const shown = await capture(page, ...kSize);
        const kept = keep(`${name}.${camera}.page`, shown);
        const { byChannel, share, far } = difference(expected, shown, nearJumps(expected));
        const words = `${byChannel.map((d) => d.toFixed(2))} of 255 over ${(100 * share).toFixed(0)} % of the pixels, ` +
          `${(100 * far).toFixed(2)} % of them off by more than 16; see ${picture} and ${kept}`;
        console.log(`${name} ${camera}: ${words}`);
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
