import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { openGlb } from './support/glb.mjs';
import { solution } from './support/lobe.mjs';
import { three } from './support/packages.mjs';
import { withPage } from './support/page.mjs';
import { srgb } from './support/pictures.mjs';
import { serve } from './support/serve.mjs';

test('A solution opens in plain three.js, and shows the baked picture', async () => {
  const bytes = readFileSync(solution('cornell_glossy')), { json, floats } = openGlb(bytes);
  const html = readFileSync(fileURLToPath(new URL('fallback.html', import.meta.url)), 'utf8');
  const site = await serve({ '/three/': three }, { 'index.html': html, 'solution.glb': bytes });
  try {
    await withPage(site.address, async (page, noticed) => {
      await page.waitForFunction(() => window.shown).catch(() => assert.fail(`nothing is shown: ${noticed.errors.join('; ')}`));
      assert.deepEqual(noticed.errors, []);
      const { mean, probes } = await page.evaluate(() => window.shown);
      assert.ok(mean > 20, `the picture is dark: its mean is ${mean} of 255`);
      assert.ok(probes.length > 200, `only ${probes.length} probes meet the scene`);
      const errors = probes.map(({ mesh, primitive, corners, weights, colour }) => {
        const baked = floats(json.meshes[mesh].primitives[primitive].attributes.COLOR_0);
        return Math.max(...[0, 1, 2].map((c) =>
          Math.abs(colour[c] - srgb(corners.reduce((sum, corner, k) => sum + weights[k] * baked[3 * corner + c], 0)))));
      }).sort((a, b) => a - b);
      // The rest are pixels that two elements share.
      assert.ok(errors[Math.floor(0.9 * errors.length)] < 2, `pixels differ from COLOR_0 by up to ${errors.slice(-40).map(Math.round)}`);
    });
  } finally {
    await site.close();
  }
});
