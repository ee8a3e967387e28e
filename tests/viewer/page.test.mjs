import assert from 'node:assert/strict';
import { test } from 'node:test';
import { keep, solution, view } from './support/lobe.mjs';
import { capture, frame, withScene } from './support/page.mjs';
import { mean } from './support/pictures.mjs';

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

test('The picture follows the size of the window', async () => {
  const site = await view(solution('cornell_glossy'));
  try {
    await withScene(`${site.address}#camera=view0`, async (page) => {
      for (const [width, height] of [[420, 700], [1100, 500]]) {
        await page.setViewportSize({ width, height });
        await page.waitForFunction((w) => window.lobe.stage.canvas.width === w * devicePixelRatio, width);
        await frame(page);
        const now = await page.evaluate(() => {
          const { canvas, camera } = window.lobe.stage;
          return { size: [canvas.width / devicePixelRatio, canvas.height / devicePixelRatio], aspect: camera.aspect };
        });
        assert.deepEqual(now.size, [width, height]);
        assert.ok(Math.abs(now.aspect - width / height) < 1e-9);
        // Nothing of the page is beside the window.
        const beyond = await page.evaluate(() => [...document.querySelectorAll('#chrome > *')]
          .filter((e) => e.getBoundingClientRect().right > innerWidth + 1 || e.getBoundingClientRect().bottom > innerHeight + 1)
          .map(({ id }) => id));
        assert.deepEqual(beyond, [], `at ${width} x ${height}`);
      }
    });
  } finally {
    await site.close();
  }
});
