import assert from 'node:assert/strict';
import { test } from 'node:test';
import { keep, solution, view } from './support/lobe.mjs';
import { capture, frame, withScene } from './support/page.mjs';
import { difference } from './support/pictures.mjs';

test('Moving the eye sends nothing to the graphics card, and the picture changes', async () => {
  const site = await view(solution('cornell_glossy'));
  try {
    await withScene(`${site.address}#camera=view0`, async (page) => {
      const stats = () => page.evaluate(() => ({ ...window.lobe.stage.stats }));
      await frame(page);
      const first = await capture(page, 320, 240), before = await stats();
      assert.ok(before.uploadedBytes > 1e5, `${before.uploadedBytes} bytes cannot be all lobes`);
      for (let i = 0; i < 10; ++i) {
        await page.evaluate(() => {
          const { stage } = window.lobe, { eye, target } = stage.pose;
          stage.setPose({ eye: eye.lerp(target, 0.02) });
        });
        await frame(page);
      }
      const now = await stats();
      assert.equal(now.uploadedBytes, before.uploadedBytes);
      assert.ok(now.frames >= before.frames + 10, `${now.frames - before.frames} frames were drawn in ten poses`);
      const last = await capture(page, 320, 240);
      keep('camera.last', last);
      assert.ok(Math.max(...difference(first, last).byChannel) > 1, 'the picture does not change with the pose');
    });
  } finally {
    await site.close();
  }
});

test('Nothing is drawn while nothing changes', async () => {
  const site = await view(solution('cornell_glossy'));
  try {
    await withScene(site.address, async (page) => {
      await page.waitForTimeout(500);
      const frames = () => page.evaluate(() => window.lobe.stage.stats.frames);
      const before = await frames();
      await page.waitForTimeout(500);
      assert.equal(await frames(), before);
    });
  } finally {
    await site.close();
  }
});
