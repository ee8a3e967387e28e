import assert from 'node:assert/strict';
import path from 'node:path';
import { test } from 'node:test';
import { bundle, keep, lobe, solution, view, work } from './support/lobe.mjs';
import { capture, withScene } from './support/page.mjs';
import { difference } from './support/pictures.mjs';
import { serve } from './support/serve.mjs';

/** The page at an address, from view0. */
const picture = (address, name) => withScene(`${address}#camera=view0`, async (page, noticed) => {
  await page.evaluate(() => window.lobe.stage.set({ exposure: 0, curve: 'srgb' }));
  const shown = await capture(page, 480, 320);
  keep(name, shown);
  assert.deepEqual(noticed.errors, []);
  assert.deepEqual(noticed.foreign, []);
  return shown;
});

for (const [what, flags, limit] of [['halves', [], 1], ['halves, gzipped', ['--gzip'], 1], ['floats', ['--float'], 1e-9]]) {
  test(`An exported folder (${what}) on any web server shows what lobe view shows`, async () => {
    const file = solution('cornell_glossy'), folder = path.join(work, `export ${what}`);
    lobe('export', file, '-o', folder, '--viewer', bundle, '--quiet', ...flags);
    const served = await view(file), site = await serve({ '/': folder });
    try {
      const expected = await picture(served.address, `export.view`), shown = await picture(site.address, `export.${what}`);
      for (const d of difference(expected, shown).byChannel) assert.ok(d <= limit, `the pictures differ by ${d} of 255`);
    } finally {
      await served.close();
      await site.close();
    }
  });
}
