import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { changeGlb } from './support/glb.mjs';
import { bundle, solution, view } from './support/lobe.mjs';
import { kSmall, withScene } from './support/page.mjs';
import { serve } from './support/serve.mjs';

const shown = (page) => page.evaluate(() => {
  const { exposure, falseColour } = window.lobe.stage.settings;
  return { exposure, show: falseColour && falseColour.quantity };
});

test('An address without an exposure has what suits the scene, whatever was before', async () => {
  const site = await view(solution('cornell_glossy'));
  try {
    await withScene(`${site.address}#camera=view0`, async (page) => {
      const suits = (await shown(page)).exposure;
      await page.evaluate(() => (location.hash = '#exposure=-7&show=degree'));
      await page.waitForFunction(() => window.lobe.stage.settings.exposure === -7);
      await page.evaluate(() => (location.hash = '#node=3'));
      await page.waitForFunction(() => document.querySelector('#panel [data-figure="node"]')?.dataset.value === '3');
      assert.deepEqual(await shown(page), { exposure: suits, show: null });
    }, kSmall);
  } finally {
    await site.close();
  }
});

test('A pose that is very near to its target comes back after a reload', async () => {
  const site = await view(solution('cornell_glossy'));
  try {
    await withScene(`${site.address}#camera=view1`, async (page) => {
      const pose = () => page.evaluate(() => {
        const { eye, target } = window.lobe.stage.pose;
        return { apart: eye.distanceTo(target), ahead: target.clone().sub(eye).normalize().toArray() };
      });
      await page.locator('#canvas').focus();
      const far = await pose();
      for (let i = 0; i < 120; ++i) await page.keyboard.press('+');
      const near = await pose();
      assert.ok(near.apart < 1e-3 * far.apart && near.apart > 1e-6 * far.apart, `${near.apart} m from the target`);
      await page.waitForTimeout(500);
      await page.reload();
      await page.evaluate(() => window.lobe.ready.then(() => {}));
      const back = await pose();
      assert.ok(Math.abs(back.apart / near.apart - 1) < 1e-3, `${back.apart} m from the target, ${near.apart} before`);
      back.ahead.forEach((v, k) => assert.ok(Math.abs(v - near.ahead[k]) < 1e-3, `looks ${back.ahead}, ${near.ahead} before`));
    }, kSmall);
  } finally {
    await site.close();
  }
});

test('A quantity that the file does not hold is not painted, and the page says why', async () => {
  const bytes = changeGlb(readFileSync(solution('cornell_glossy')), ({ extensions }) => {
    for (const material of extensions.LOBE_directional_radiance.materials) delete material.albedo;
  });
  const site = await serve({ '/': bundle }, { 'view.json': { solution: 'solution.glb', title: 'room' }, 'solution.glb': bytes });
  try {
    await withScene(`${site.address}#show=irradiance`, async (page) => {
      assert.equal((await shown(page)).show, null);
      assert.match(await page.locator('#status').innerText(), /albedo/);
    }, kSmall);
  } finally {
    await site.close();
  }
});
