import assert from 'node:assert/strict';
import { test } from 'node:test';
import { solution, view } from './support/lobe.mjs';
import { capture, withScene } from './support/page.mjs';
import { keep, mean } from './support/pictures.mjs';

test('The page shows a solution without an error, and asks nobody but its own server', async () => {
  const site = await view(solution('cornell_glossy'));
  try {
    await withScene(site.address, async (page, noticed) => {
      await page.waitForTimeout(300);
      assert.deepEqual(noticed.errors, []);
      assert.deepEqual(noticed.foreign, []);
      const shown = await capture(page, 320, 240);
      keep('page', shown);
      assert.ok(mean(shown) > 10, `the picture is black: its mean is ${mean(shown)}`);
      assert.match(await page.title(), /cornell_glossy\.solution\.glb/);
    });
  } finally {
    assert.equal(await site.close(), 0, 'lobe view ends well when it is interrupted');
  }
});
