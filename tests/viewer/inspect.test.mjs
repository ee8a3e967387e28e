import assert from 'node:assert/strict';
import { test } from 'node:test';
import { lobe, solution, view } from './support/lobe.mjs';
import { withScene } from './support/page.mjs';

/** Pixels of the canvas where a material is seen and one node clearly weighs most, spread over them. */
const pixelsOf = (page, material) => page.evaluate((name) => {
  const { stage, solution } = window.lobe, found = [];
  const rect = document.querySelector('#canvas').getBoundingClientRect();
  for (let y = 10; y < rect.height; y += 9) {
    for (let x = 10; x < rect.width; x += 9) {
      if (document.elementFromPoint(rect.left + x + 0.5, rect.top + y + 0.5)?.id !== 'canvas') continue;
      const pick = stage.pick(x + 0.5, y + 0.5);
      if (!pick || solution.materials[pick.patch.material].name !== name) continue;
      const [first, second] = [...pick.weights].sort((a, b) => b - a);
      if (first > second + 0.1) found.push({ x, y });
    }
  }
  return found.filter((_, i) => i % Math.ceil(found.length / 4) === 0);
}, material);

const value = (page, figure) => page.locator(`#panel [data-figure="${figure}"]`).first().getAttribute('data-value');

test('A click on the aluminium block selects the node that lobe inspect names, with the same figures', async () => {
  const file = solution('cornell_glossy'), site = await view(file);
  try {
    await withScene(`${site.address}#camera=view0`, async (page) => {
      const rect = await page.locator('#canvas').boundingBox();
      const pixels = await pixelsOf(page, 'brushed aluminium');
      assert.ok(pixels.length >= 3, `the block is seen in ${pixels.length} pixels`);
      for (const { x, y } of pixels) {
        const expected = JSON.parse(lobe('inspect', file, '--camera', 'view0', '--json',
          '--size', `${Math.round(rect.width)}x${Math.round(rect.height)}`, '--pixel', `${x},${y}`));
        assert.equal(expected.material, 'brushed aluminium');
        await page.mouse.click(rect.x + x + 0.5, rect.y + y + 0.5);
        await page.waitForFunction(
          (node) => document.querySelector('#panel [data-figure="node"]')?.getAttribute('data-value') === node,
          String(expected.node), { timeout: 10000 },
        ).catch(async () => assert.fail(`pixel ${x},${y}: node ${await value(page, 'node')}, expected ${expected.node}`));
        await page.waitForURL((url) => url.hash.split('&').includes(`node=${expected.node}`), { timeout: 10000 });

        const flux = (await value(page, 'flux')).match(/[-+.\de]+/g).map(Number);
        assert.equal(flux.length, 3);
        flux.forEach((f, c) => assert.ok(Math.abs(f - expected.flux[c]) <= 1e-3 * Math.abs(expected.flux[c]),
          `flux of node ${expected.node} is ${flux}, expected ${expected.flux}`));
        assert.equal(await value(page, 'material'), 'brushed aluminium');
        assert.equal(await value(page, 'kind'), expected.kind);
        assert.equal(Number(await value(page, 'lMax')), Math.max(expected.l_max_base ?? 0, expected.l_max_gloss ?? 0));
      }
    });
  } finally {
    await site.close();
  }
});

test('A hand that shakes within the slop still clicks, and a drag does not', async () => {
  const site = await view(solution('cornell_glossy'));
  try {
    await withScene(`${site.address}#camera=view0`, async (page) => {
      const rect = await page.locator('#canvas').boundingBox();
      const [{ x, y }] = await pixelsOf(page, 'brushed aluminium');
      const press = async (moves) => {
        await page.mouse.move(rect.x + x, rect.y + y);
        await page.mouse.down();
        for (const [dx, dy] of moves) await page.mouse.move(rect.x + x + dx, rect.y + y + dy);
        await page.mouse.up();
      };
      const node = page.locator('#panel [data-figure="node"]');
      await press([[40, 0], [0, 0]]);
      assert.equal(await node.count(), 0);
      await press([[2, 0], [2, 1], [1, 2], [2, 2], [3, 1], [2, 0], [2, 1]]);
      await node.waitFor({ state: 'visible', timeout: 10000 });
      assert.equal(await node.count(), 1);
    });
  } finally {
    await site.close();
  }
});

test('A node that is compared with none is the first', async () => {
  const site = await view(solution('cornell_glossy'));
  try {
    await withScene(site.address, async (page) => {
      const seats = () => page.locator('#panel [data-figure="node"]').evaluateAll((all) =>
        all.map(({ dataset }) => [dataset.seat, dataset.value]));
      await page.evaluate(() => window.lobe.compare(1234));
      assert.deepEqual(await seats(), [['first', '1234']]);
      await page.waitForURL((url) => url.hash.split('&').includes('node=1234') && !url.hash.includes('compare'));
      await page.evaluate(() => window.lobe.compare(2000));
      assert.deepEqual(await seats(), [['first', '1234'], ['second', '2000']]);
    });
  } finally {
    await site.close();
  }
});

test('figures() says what lobe inspect says, under its names', async () => {
  const file = solution('cornell_glossy'), site = await view(file);
  // Only a solution knows these, and base and gloss are one here.
  const elsewhere = ['direct_flux', 'l_max_base', 'l_max_gloss'];
  try {
    await withScene(site.address, async (page) => {
      const expected = JSON.parse(lobe('inspect', file, '--node', '1234', '--json'));
      const said = await page.evaluate(() => window.lobe.figures(1234));
      for (const name of Object.keys(expected)) assert.equal(name in said, !elsewhere.includes(name), name);
      assert.equal(said.l_max, Math.max(expected.l_max_base ?? 0, expected.l_max_gloss ?? 0));
      for (const name of ['lMax', 'negative', 'normal']) assert.ok(!(name in said), `${name} has a name already`);
    });
  } finally {
    await site.close();
  }
});
