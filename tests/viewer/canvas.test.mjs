import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { bundle, solution, view } from './support/lobe.mjs';
import { capture, frame, withScene } from './support/page.mjs';
import { mean } from './support/pictures.mjs';
import { serve } from './support/serve.mjs';

const withView = async (scene, look) => {
  const site = await view(solution(scene));
  try {
    await withScene(`${site.address}#camera=view0`, look);
  } finally {
    await site.close();
  }
};

test('A graphics card that forgot everything shows the same again', () => withView('cornell_glossy', async (page) => {
  const warnings = [];
  page.on('console', (message) => message.type() === 'warning' && warnings.push(message.text()));
  await page.evaluate(() => {
    window.lobe.select(4);
    window.losing = document.querySelector('#canvas').getContext('webgl2').getExtension('WEBGL_lose_context');
  });
  await frame(page);
  // As light; and in false colours from so far away that some of the picture shows nothing, which has none.
  const pictures = async () => [await capture(page, 320, 240), await page.evaluate(() => {
    const { stage } = window.lobe, { eye, target } = stage.pose;
    stage.setPose({ eye: target.clone().lerp(eye, 2) });
    stage.set({ falseColour: { quantity: 'radiance', low: 0, high: 0.5, logarithmic: false } });
  }).then(() => capture(page, 320, 240)), await page.evaluate(() => {
    const { stage } = window.lobe, { eye, target } = stage.pose;
    stage.setPose({ eye: target.clone().lerp(eye, 0.5) });
    stage.set({ falseColour: null });
  })].slice(0, 2);
  const before = await pictures();
  for (const picture of before) assert.ok(mean(picture) > 1, `its mean is ${mean(picture)}`);
  assert.deepEqual([...before[1].data.subarray(0, 3)], [0, 0, 0]);

  const refusal = await page.evaluate(async () => {
    const canvas = document.querySelector('#canvas'), lost = new Promise((done) => canvas.addEventListener('webglcontextlost', done));
    window.losing.loseContext();
    await lost;
    try {
      window.lobe.stage.capture(320, 240);
    } catch (error) {
      return error.message;
    }
    return null;
  });
  assert.match(refusal ?? 'nothing', /graphics card/);

  await page.evaluate(async () => {
    const canvas = document.querySelector('#canvas'), restored = new Promise((done) => canvas.addEventListener('webglcontextrestored', done));
    window.losing.restoreContext();
    await restored;
  });
  await frame(page);
  (await pictures()).forEach(({ data }, i) => assert.equal(Buffer.compare(data, before[i].data), 0, `picture ${i} is another`));
  // What is let go after it, too.
  await page.evaluate(() => window.lobe.select(5));
  await frame(page);
  assert.deepEqual(warnings.filter((text) => /belong|INVALID/.test(text)), []);
}));

test('A canvas of a new size is not black until the next frame', () => withView('cornell_glossy', async (page) => {
  const shown = await page.evaluate(() => new Promise((done) => {
    const canvas = document.querySelector('#canvas'), gl = canvas.getContext('webgl2');
    // After the page's own observer, and before anything is painted.
    const observer = new ResizeObserver(() => {
      if (canvas.width === before) return;
      const pixel = new Uint8Array(4);
      gl.readPixels(canvas.width >> 1, canvas.height >> 1, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      done([...pixel]);
    });
    const before = canvas.width;
    observer.observe(canvas);
    canvas.style.width = '500px';
  }));
  assert.ok(Math.max(...shown.slice(0, 3)) > 5, `the middle is ${shown}`);
}));

test('A picture is asked for in whole pixels', () => withView('cornell_glossy', async (page) => {
  for (const [width, height] of [[100.5, 80], [0, 80], [100, NaN], [1e6, 10]]) {
    const said = await page.evaluate(([w, h]) => {
      const { canvas } = window.lobe.stage, before = [canvas.width, canvas.height];
      try {
        window.lobe.stage.capture(w, h);
      } catch (error) {
        return [error.message, canvas.width === before[0] && canvas.height === before[1]];
      }
      return ['nothing', true];
    }, [width, height]);
    assert.match(said[0], /each side can have 1 to/);
    assert.ok(said[1], 'the canvas has another size');
  }
}));

test('A solution without cameras is not opened on a black box', async () => {
  const bytes = readFileSync(solution('cornell_glossy'));
  for (let at; (at = bytes.indexOf('"camera":')) > 0; ) bytes.write('"kamera":', at);
  const site = await serve({ '/': bundle }, { 'view.json': { solution: 's.glb', title: 'room' }, 's.glb': bytes });
  try {
    await withScene(site.address, async (page) => {
      assert.equal(await page.evaluate(() => window.lobe.solution.cameras.length), 0);
      const inside = mean(await capture(page, 320, 240));
      await page.evaluate(() => window.lobe.stage.set({ seeThroughBacks: false }));
      const outside = mean(await capture(page, 320, 240));
      assert.ok(inside > 5 && inside > 2 * outside, `the mean is ${inside}, with black backs ${outside}`);
    });
  } finally {
    await site.close();
  }
});

test('What curved glass reflects follows the slider of degrees once that rests', () => withView('glass_room', async (page) => {
  const still = await page.evaluate(() => {
    window.lobe.stage.drawNow();
    return window.lobe.stage.stats.drawCalls;
  });
  // The frame after: the stage asked for its own first.
  const moving = await page.evaluate(() => {
    const { stage } = window.lobe;
    stage.set({ degree: 0 });
    return new Promise((done) => requestAnimationFrame(() => done(stage.stats.drawCalls)));
  });
  assert.equal(moving, still);
  await page.waitForFunction((most) => window.lobe.stage.stats.drawCalls > most, still, { timeout: 10000 });
}));
