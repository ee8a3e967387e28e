import assert from 'node:assert/strict';
import path from 'node:path';
import { test } from 'node:test';
import { solution, view } from './support/lobe.mjs';
import { kSmall, ready, withPage, withScene } from './support/page.mjs';

const title = (page) => page.locator('#title').innerText();
const called = (page, name) => page.waitForFunction((n) => document.querySelector('#title').textContent === n, name);

test('Another solution opens by its file, and takes the place of the first', async () => {
  const site = await view(solution('cornell_glossy')), other = solution('glossy_floor');
  try {
    await withScene(`${site.address}#node=12&show=density`, async (page, noticed) => {
      const before = await page.evaluate(() => window.lobe.solution.nodeCount);
      await page.locator('#file').setInputFiles(other);
      await called(page, path.basename(other));
      const now = await page.evaluate(() => ({ nodes: window.lobe.solution.nodeCount, width: window.lobe.stage.canvas.width }));
      assert.notEqual(now.nodes, before);
      assert.ok(now.width > 100, 'the new canvas has a size');
      assert.equal(await page.locator('#panel [data-figure="node"]').count(), 0);
      assert.ok(await page.locator('#legend').isHidden());
      assert.ok(await page.locator('#loading').isHidden());
      assert.deepEqual(noticed.foreign, []);

      // What is no solution is answered, and leaves this one where it is.
      await page.locator('#file').setInputFiles({ name: 'notes.txt', mimeType: 'text/plain', buffer: Buffer.from('hello') });
      await page.getByRole('button', { name: 'Back', exact: true }).click();
      assert.equal(await title(page), path.basename(other));
    }, kSmall);
  } finally {
    await site.close();
  }
});

test('A file that is opened while another is fetched stays', async () => {
  const first = solution('cornell_glossy'), second = solution('glossy_floor'), site = await view(first);
  try {
    await withPage('about:blank', async (page, noticed) => {
      let fetched, goOn;
      const asked = new Promise((resolve) => (fetched = resolve)), held = new Promise((resolve) => (goOn = resolve));
      await page.route('**/*.glb', async (route) => {
        fetched();
        await held;
        await route.continue();
      });
      await page.goto(site.address);
      await asked;
      await page.locator('#file').setInputFiles(second);
      await called(page, path.basename(second));
      goOn();
      await ready(page, noticed);
      // Time to read it, if somebody did.
      await page.waitForTimeout(1000);
      assert.equal(await title(page), path.basename(second));
      assert.ok(await page.locator('#loading').isHidden());
      assert.deepEqual(noticed.errors, []);
    }, kSmall);
  } finally {
    await site.close();
  }
});
