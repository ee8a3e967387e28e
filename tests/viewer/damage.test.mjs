import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { bundle, scene, solution } from './support/lobe.mjs';
import { withPage } from './support/page.mjs';
import { serve } from './support/serve.mjs';

/** A solution whose JSON has one text replaced by another of the same length. */
function changed(bytes, from, to) {
  const at = bytes.indexOf(from);
  assert.ok(at > 0 && from.length === to.length);
  const out = Buffer.from(bytes);
  out.write(to, at);
  return out;
}

const whole = () => readFileSync(solution('cornell_glossy'));

const files = {
  'A file that was cut off': [() => whole().subarray(0, 100000), /damaged or not whole/],
  'A file whose JSON is torn': [() => changed(whole(), '"asset"', '"asset['), /JSON that is damaged/],
  'A file whose sizes are wrong': [() => changed(whole(), '"count":', '"counb":'), /damaged/],
  'A file of a newer format version': [() => changed(whole(), '"version":1', '"version":7'), /format version 7/],
  'A glTF file without lobes': [() => readFileSync(scene('cornell_glossy')), /without lobes/],
  'A file that is something else': [() => Buffer.from('hello'), /neither a \.glb nor a \.gltf/],
  'An empty file': [() => Buffer.alloc(0), /is empty/],
  'A missing file': [() => null, /cannot be fetched.*404/],
};

/** What the page shows in its place; fails if that is not seen, or if scripts ended with an error. */
async function problemAt(address) {
  return withPage(address, async (page, noticed) => {
    await page.locator('#problem').waitFor({ state: 'visible', timeout: 20000 });
    assert.deepEqual(noticed.errors.filter((text) => !/Failed to load resource.*404/.test(text)), []);
    return page.locator('#problem').innerText();
  });
}

for (const [what, [bytes, cause]] of Object.entries(files)) {
  test(`${what} is answered by a sentence with its name and the cause`, async () => {
    const content = bytes();
    const site = await serve({ '/': bundle }, {
      'view.json': { solution: 'solution.glb', title: 'my room.glb' },
      ...(content ? { 'solution.glb': content } : {}),
    });
    try {
      const sentence = await problemAt(site.address);
      assert.match(sentence, /my room\.glb/);
      assert.match(sentence, cause);
    } finally {
      await site.close();
    }
  });
}

test('A page without view.json says so', async () => {
  const site = await serve({ '/': bundle });
  try {
    assert.match(await problemAt(site.address), /view\.json.*404/);
  } finally {
    await site.close();
  }
});
