import assert from 'node:assert/strict';
import { test } from 'node:test';
import { keep, solution, view } from './support/lobe.mjs';
import { capture, kSmall, withScene } from './support/page.mjs';
import { difference } from './support/pictures.mjs';

test('False colours change the picture, and the legend says what they mean', async () => {
  const site = await view(solution('cornell_glossy'));
  try {
    await withScene(`${site.address}#camera=view0`, async (page) => {
      const legend = page.locator('#legend');
      assert.ok(await legend.isHidden());
      let before = await capture(page, 240, 160);
      // Exposure is the picture's alone.
      for (const [show, unit] of [['density', '1/m²'], ['negative', 'of the flux'], ['radiance', 'W/(m² sr)']]) {
        await page.locator('#show').selectOption(show);
        assert.ok(await legend.isVisible());
        assert.ok((await legend.innerText()).includes(unit), `${show}: ${await legend.innerText()}`);
        assert.ok((await page.locator('#legend .ticks span').count()) >= 2);
        const now = await capture(page, 240, 160);
        keep(`false.${show}`, now);
        assert.ok(Math.max(...difference(before, now).byChannel) > 5, `${show} looks like what was before it`);
        before = now;
      }
      await page.evaluate(() => window.lobe.stage.set({ exposure: 3 }));
      assert.deepEqual(difference(before, await capture(page, 240, 160)).byChannel, [0, 0, 0]);
      const { low, high } = await page.evaluate(() => window.lobe.stage.settings.falseColour), lower = (3 * low + high) / 4;
      await page.locator('#legend-high').fill(String(lower));
      await page.locator('#legend-high').press('Enter');
      assert.equal(await page.evaluate(() => window.lobe.stage.settings.falseColour.high), lower);
      assert.ok(Math.max(...difference(before, await capture(page, 240, 160)).byChannel) > 5, 'the scale changes nothing');
    }, kSmall);
  } finally {
    await site.close();
  }
});

test('Kinds of gloss are few colours, those of the legend', async () => {
  const site = await view(solution('cornell_glossy'));
  try {
    await withScene(`${site.address}#camera=view0&show=kind`, async (page) => {
      const listed = await page.locator('#legend .kinds i').evaluateAll((all) =>
        all.map((i) => getComputedStyle(i).backgroundColor.match(/\d+/g).map(Number)));
      assert.ok(listed.length >= 3);
      assert.ok(await page.locator('#legend .scale').isHidden());
      const { data, width, height } = await capture(page, 240, 160);
      keep('false.kind', { data, width, height });
      const seen = new Set();
      let known = 0;
      for (let i = 0; i < data.length; i += 4) {
        const which = listed.findIndex((colour) => colour.every((v, c) => Math.abs(v - data[i + c]) <= 2));
        if (which < 0) continue;
        ++known;
        seen.add(which);
      }
      // The rest are lamps, backs and what lies between two.
      assert.ok(known > 0.8 * width * height, `${known} pixels have a colour of the legend`);
      assert.ok(seen.size >= 2, 'the room has diffuse and glossy walls');
    }, kSmall);
  } finally {
    await site.close();
  }
});
