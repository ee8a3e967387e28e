import assert from 'node:assert/strict';
import { test } from 'node:test';
import { bundle } from './support/lobe.mjs';
import { source } from './support/packages.mjs';
import { capture, withScene } from './support/page.mjs';
import { srgb } from './support/pictures.mjs';
import { serve } from './support/serve.mjs';

const { Glb } = await source('tests/support/glb.ts');
const { frameOf, toLocal } = await source('src/sh/frame.ts');
const { coefficientCount, hemisphereBasis } = await source('src/sh/zernike.ts');

const kDegree = 5, kCount = coefficientCount(kDegree);
/** A zero has a sign, too, by which frames are told apart (docs/conventions.md#frame). */
const normals = [[0.36, 0.48, 0.8], [0.3, 0.5, -0.81], [0.6, 0.8, 0], [0.6, 0.8, -0], [1, 0, -0], [0, 1, -0], [0, 0, -1]]
  .map((n) => n.map((v) => v / Math.hypot(...n)));
const lobe = Array.from({ length: kCount }, (_, k) => (k === 0 ? 2 : 0.25 * Math.sin(2.7 * k + 1)));

/** None is before another. */
const place = (i) => [20 * i, 7 * i * i, -11 * i * (i % 3)];

/** A patch for every normal: a square, all of whose nodes have that lobe. */
function squares() {
  const glb = new Glb(), vec3 = (values) => glb.accessor(Float32Array.from(values), 'VEC3');
  const repeat = (values, times) => Array.from({ length: times }, () => values).flat();
  const primitives = normals.map((n, i) => {
    const { x, y } = frameOf(n);
    const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].flatMap(([a, b]) => place(i).map((p, c) => p + a * x[c] + b * y[c]));
    return {
      attributes: { POSITION: vec3(corners), NORMAL: vec3(repeat(n, 4)), COLOR_0: vec3(Array(12).fill(1)) },
      indices: glb.accessor(Uint32Array.of(0, 1, 2, 0, 2, 3)),
      material: 0,
      extensions: { LOBE_directional_radiance: {
        patch: i, material: 0, surface: 0, side: 'front', planar: true, lMaxGloss: kDegree,
        gloss: glb.accessor(Float32Array.from(repeat(lobe, 12))),
      } },
    };
  });
  Object.assign(glb.json, {
    extensionsUsed: ['LOBE_directional_radiance'],
    meshes: [{ primitives }], nodes: [{ mesh: 0 }], scenes: [{ nodes: [0] }], scene: 0,
    materials: [{ name: 'lacquer' }],
    extensions: { LOBE_directional_radiance: {
      version: 1, basis: 'H', frame: 'duff2017', exposureScale: 1, surfaceNames: ['squares'],
      materials: [{ kind: 'lobe', error: 0 }],
    } },
  });
  return Buffer.from(glb.bytes());
}

const radiance = (normal, w) => {
  const basis = hemisphereBasis(kDegree, toLocal(frameOf(normal), w));
  return lobe.reduce((sum, value, k) => sum + value * basis[k], 0);
};

test('The picture shows lobes as their sums say, in frames of all normals', async () => {
  const site = await serve({ '/': bundle }, { 'view.json': { solution: 's.glb', title: 'squares' }, 's.glb': squares() });
  try {
    await withScene(site.address, async (page) => {
      await page.evaluate(() => window.lobe.stage.set({ curve: 'srgb', exposure: -1 }));
      let apart = 0;
      for (const [i, normal] of normals.entries()) {
        const { x, y, z } = frameOf(normal);
        for (let step = 0; step < 2; ++step) {
          const theta = 0.4 + 0.6 * step, phi = 1 + 2.1 * step;
          const local = [Math.sin(theta) * Math.cos(phi), Math.sin(theta) * Math.sin(phi), Math.cos(theta)];
          const w = [0, 1, 2].map((c) => local[0] * x[c] + local[1] * y[c] + local[2] * z[c]);
          // So far away that the direction is one for all of the square.
          await page.evaluate(({ at, w }) => {
            const { stage } = window.lobe, vector = (v) => stage.target.clone().set(...v);
            stage.setPose({ target: vector(at), eye: vector(at.map((p, c) => p + 300 * w[c])), up: vector([0.1, 1, 0.2]), fov: 0.02 });
          }, { at: place(i), w });
          const { data } = await capture(page, 9, 9);
          const expected = srgb(0.5 * radiance(normal, w)), shown = data[4 * 40];
          assert.ok(expected > 20 && expected < 250, `radiance there tells nothing: ${expected} of 255`);
          assert.ok(Math.abs(shown - expected) < 2, `normal ${normal}, towards ${w}: ${shown} of 255, expected ${expected}`);
          if (Object.is(normal[2], -0)) apart = Math.max(apart, Math.abs(radiance([normal[0], normal[1], 0], w) - radiance(normal, w)));
        }
      }
      assert.ok(apart > 0.2, 'the sign of zero makes no difference here');
    });
  } finally {
    await site.close();
  }
});
