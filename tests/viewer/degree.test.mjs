import assert from 'node:assert/strict';
import { test } from 'node:test';
import { keep, solution, view } from './support/lobe.mjs';
import { capture, withScene } from './support/page.mjs';
import { difference, mean, srgb } from './support/pictures.mjs';

const setDegree = (page, degree) => page.locator('#degree').evaluate((slider, value) => {
  slider.value = String(value);
  for (const type of ['input', 'change']) slider.dispatchEvent(new Event(type, { bubbles: true }));
}, degree);

test('The slider of degrees keeps the flux of every node and the brightness of the picture, and changes lobes', async () => {
  const site = await view(solution('cornell_glossy'));
  try {
    await withScene(`${site.address}#camera=view0`, async (page) => {
      // A prime step, so that all patches have some.
      const fluxes = () => page.evaluate(() => {
        const out = [];
        for (let node = 0; node < window.lobe.solution.nodeCount; node += 71) out.push(window.lobe.figures(node).flux);
        return out;
      });
      await page.evaluate(() => window.lobe.stage.set({ exposure: 0, curve: 'srgb' }));
      const most = Number(await page.locator('#degree').getAttribute('max'));
      assert.ok(most >= 12, `the slider goes to ${most}, and the solution has degree 12`);

      await setDegree(page, most);
      const whole = await fluxes(), wholePicture = await capture(page, 320, 240);
      assert.ok(whole.length > 40);
      for (let degree = most - 1; degree >= 0; --degree) {
        await setDegree(page, degree);
        assert.equal(await page.evaluate(() => window.lobe.stage.settings.degree), degree);
        (await fluxes()).forEach((flux, i) => flux.forEach((f, c) => assert.ok(
          Math.abs(f - whole[i][c]) <= 1e-3 * Math.abs(whole[i][c]) + 1e-9,
          `at degree ${degree} node ${71 * i} has flux ${flux}, and ${whole[i]} at ${most}`)));
      }

      const glossy = await page.evaluate(() => window.lobe.solution.patches
        .find((p) => window.lobe.solution.materials[p.material].name === 'brushed aluminium').firstNode);
      const peak = () => page.evaluate((node) => window.lobe.figures(node).peak.luminance, glossy);
      const flatPeak = await peak();
      await setDegree(page, most);
      const wholePeak = await peak();
      assert.ok(wholePeak > 1.1 * flatPeak, `the lobe of node ${glossy} peaks at ${wholePeak}, cut at 0 at ${flatPeak}`);
      await setDegree(page, 0);

      const flat = await capture(page, 320, 240);
      keep('degree.0', flat);
      keep('degree.whole', wholePicture);
      assert.ok(Math.abs(mean(flat) - mean(wholePicture)) < 0.1 * mean(wholePicture),
        `the picture's mean is ${mean(flat)} at degree 0, and ${mean(wholePicture)} at ${most}`);
      assert.ok(Math.max(...difference(flat, wholePicture).byChannel) > 0.5, 'nothing changes with the degree');

      // At degree 0 radiance is flux / π, whoever looks from where: on the block, in the very pixels.
      const probes = await page.evaluate(() => {
        const { stage, solution, figures } = window.lobe, rect = stage.canvas.getBoundingClientRect(), out = [];
        for (let y = 20.5; y < rect.height; y += 31) {
          for (let x = 20.5; x < rect.width; x += 31) {
            const pick = stage.pick(x, y);
            if (!pick || solution.materials[pick.patch.material].name !== 'brushed aluminium') continue;
            const radiance = [0, 1, 2].map((c) =>
              pick.nodes.reduce((sum, node, k) => sum + (pick.weights[k] * figures(node).flux[c]) / Math.PI, 0));
            out.push({ x: Math.floor(x), y: Math.floor(y), radiance });
          }
        }
        return { width: Math.round(rect.width), height: Math.round(rect.height), out };
      });
      assert.ok(probes.out.length > 10, `the block is seen at ${probes.out.length} probes`);
      const large = await capture(page, probes.width, probes.height);
      const errors = probes.out.flatMap(({ x, y, radiance }) =>
        radiance.map((v, c) => Math.abs(srgb(v) - large.data[4 * (y * probes.width + x) + c])));
      errors.sort((a, b) => a - b);
      // Some probes lie on an edge of the block.
      assert.ok(errors[Math.floor(0.8 * errors.length)] < 2, `the block is off by up to ${errors} of 255`);
    });
  } finally {
    await site.close();
  }
});
