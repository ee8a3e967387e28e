import assert from 'node:assert/strict';
import { test } from 'node:test';
import { solution, view } from './support/lobe.mjs';
import { frame, withScene } from './support/page.mjs';

const pose = (page) => page.evaluate(() => {
  const { eye, target, fov } = window.lobe.stage.pose;
  return [...eye.toArray(), ...target.toArray(), fov];
});

const assertNear = (actual, expected, why) =>
  actual.forEach((v, i) => assert.ok(Math.abs(v - expected[i]) < 1e-3, `${why}: ${actual}, expected ${expected}`));

const withView = async (hash, look) => {
  const site = await view(solution('cornell_glossy'));
  try {
    await withScene(`${site.address}${hash}`, look);
  } finally {
    await site.close();
  }
};

test('Tab reaches every control', () => withView('', async (page) => {
  const reached = new Set();
  for (let i = 0; i < 60; ++i) {
    await page.keyboard.press('Tab');
    reached.add(await page.evaluate(() => {
      const at = document.activeElement;
      return at?.closest('#cameras')?.id ?? at?.id;
    }));
  }
  for (const id of ['canvas', 'degree', 'exposure', 'cameras', 'screenshot']) {
    assert.ok(reached.has(id), `Tab never comes to #${id}, only to ${[...reached].join(', ')}`);
  }
}));

test('A question mark opens the help, Escape closes it', () => withView('', async (page) => {
  const help = page.locator('dialog:visible, [role="dialog"]:visible');
  assert.equal(await help.count(), 0);
  await page.keyboard.press('?');
  await help.waitFor({ state: 'visible', timeout: 5000 });
  assert.match(await help.innerText(), /Escape|Esc/);
  await page.keyboard.press('Escape');
  await help.waitFor({ state: 'hidden', timeout: 5000 });
}));

test('R goes back to the first camera', () => withView('', async (page) => {
  const before = await pose(page);
  await page.evaluate(() => {
    const { stage } = window.lobe, { eye } = stage.pose;
    stage.setPose({ eye: eye.addScalar(0.5), fov: 30 });
  });
  await frame(page);
  assert.ok(Math.abs((await pose(page))[0] - before[0]) > 0.4);
  await page.keyboard.press('r');
  // It flies there.
  await page.waitForFunction((wanted) => {
    const { eye, target, fov } = window.lobe.stage.pose;
    return [...eye.toArray(), ...target.toArray(), fov].every((v, i) => Math.abs(v - wanted[i]) < 1e-3);
  }, before, { timeout: 10000 }).catch(() => {});
  assertNear(await pose(page), before, 'the pose after R');
}));

test('Enter selects, and the address brings back node and pose', () => withView('#camera=view0', async (page) => {
  await page.locator('#canvas').focus();
  await page.evaluate(() => {
    const { stage } = window.lobe, { eye } = stage.pose;
    stage.setPose({ eye: eye.addScalar(-0.125) });  // the other way is through the wall
  });
  await page.keyboard.press('Enter');
  const node = page.locator('#panel [data-figure="node"]').first();
  await node.waitFor({ state: 'visible', timeout: 10000 });
  const selected = await node.getAttribute('data-value'), before = await pose(page);
  await page.waitForFunction((n) => location.hash.includes(`node=${n}`), selected, { timeout: 10000 });

  await page.reload();
  await page.waitForFunction(() => window.lobe);
  await page.evaluate(async () => void (await window.lobe.ready));
  await node.waitFor({ state: 'visible', timeout: 10000 });
  assert.equal(await node.getAttribute('data-value'), selected);
  assertNear(await pose(page), before, 'the pose after a reload');
}));

test('#node=N opens with that node selected', () => withView('#node=1234', async (page) => {
  const node = page.locator('#panel [data-figure="node"]').first();
  await node.waitFor({ state: 'visible', timeout: 10000 });
  assert.equal(await node.getAttribute('data-value'), '1234');
}));
