import { describe, expect, it } from 'vitest';
import type { Glb } from './support/glb';
import { open, openResponse, problemOf } from './support/open';
import { room } from './support/room';

const kExtension = 'LOBE_directional_radiance';

/** The parts of the room that are damaged below. */
function parts(glb: Glb) {
  const [wall] = glb.json.meshes[0].primitives, [floor] = glb.json.meshes[1].primitives;
  return {
    glb, json: glb.json, wall, floor, document: glb.json.extensions[kExtension],
    floorLobes: floor.extensions[kExtension], wallLobes: wall.extensions[kExtension],
  };
}

type Damage = [what: string, damage: (room: ReturnType<typeof parts>) => void, sentence: RegExp];

const damages: Damage[] = [
  ['no extension', ({ json }) => delete json.extensions, /is a glTF file without lobes; expected one that `lobe solve`/],
  ['a newer version', ({ document }) => (document.version = 2), /is of format version 2, and this viewer reads version 1/],
  ['no version', ({ document }) => delete document.version, /is of format version undefined/],
  ['another basis', ({ document }) => (document.basis = 'SH'), /has basis "SH" and frame "duff2017", expected "H"/],
  ['no materials', ({ document }) => delete document.materials, /has no list "materials"/],
  ['names that are none', ({ document }) => (document.surfaceNames = 3), /has no list "surfaceNames"/],
  ['an exposure of nothing', ({ document }) => (document.exposureScale = 0), /has exposureScale 0, expected a positive/],
  ['a kind nobody knows', ({ document }) => (document.materials[1].kind = 'velvet'), /material 1 is of kind "velvet"/],
  ['a material that is null', ({ document }) => (document.materials[1] = null), /material 1 is of kind "undefined"/],
  ['no accessor of a part', ({ floorLobes }) => delete floorLobes.gloss, /patch 0's gloss is missing/],
  ['an accessor beyond the last', ({ floorLobes }) => (floorLobes.gloss = 99), /patch 0's gloss is accessor 99, expected below/],
  ['an accessor that is no number', ({ floorLobes }) => (floorLobes.gloss = 'x'), /patch 0's gloss is accessor x/],
  ['too few coefficients', ({ floorLobes }) => (floorLobes.lMaxGloss = 5), /gloss has 180 entries of 1 numbers, expected 252/],
  ['a huge degree', ({ floorLobes }) => (floorLobes.lMaxGloss = 4e9), /patch 0's gloss is of degree 4000000000, expected 0 to/],
  ['a negative degree', ({ floorLobes }) => (floorLobes.lMaxBase = -1), /patch 0's base is of degree -1/],
  ['half a degree', ({ floorLobes }) => (floorLobes.lMaxBase = 0.5), /patch 0's base is of degree 0.5/],
  ['a coefficient that is NaN', ({ glb, floorLobes }) => (glb.values[floorLobes.gloss][7] = NaN), /gloss holds .* not a number/],
  ['an infinite one', ({ glb, floorLobes }) => (glb.values[floorLobes.base][7] = -Infinity), /base holds .* not a number/],
  ['a place that is NaN', ({ glb, wall }) => (glb.values[wall.attributes.POSITION][0] = NaN), /patch 1's POSITION holds/],
  ['an index out of range', ({ glb, wall }) => (glb.values[wall.indices][1] = 3), /patch 1's elements has index 3, expected below 3/],
  ['no indices', ({ wall }) => delete wall.indices, /patch 1's elements is missing/],
  ['two indices', ({ json, wall }) => (json.accessors[wall.indices].count = 2), /has 2 indices, expected a multiple of 3/],
  ['no normals', ({ wall }) => delete wall.attributes.NORMAL, /patch 1's NORMAL is missing/],
  ['no colours', ({ wall }) => delete wall.attributes.COLOR_0, /patch 1's COLOR_0 is missing/],
  ['fewer normals than nodes', ({ json, wall }) => (json.accessors[wall.attributes.NORMAL].count = 2),
    /patch 1's NORMAL has 2 entries of 3 numbers, expected 3 of 3/],
  ['fewer hidden than nodes', ({ json, wallLobes }) => (json.accessors[wallLobes.hidden].count = 2), /patch 1's hidden has 2 entries/],
  ['a patch twice', ({ wallLobes }) => (wallLobes.patch = 0), /patch 1 is missing or there twice/],
  ['a patch without number', ({ wallLobes }) => delete wallLobes.patch, /a primitive has no "patch"/],
  ['a primitive without lobes', ({ wall }) => delete wall.extensions, /a primitive has no "patch"/],
  ['a material beyond the last', ({ wallLobes }) => (wallLobes.material = 3), /patch 1 is of material 3, expected below 3/],
  ['half a material', ({ wallLobes }) => (wallLobes.material = 0.5), /patch 1 is of material 0.5/],
  ['a negative surface', ({ wallLobes }) => (wallLobes.surface = -1), /patch 1 is of surface -1, expected below 3/],
  ['a third side', ({ wallLobes }) => (wallLobes.side = 'edge'), /patch 1 is on side "edge", expected "front" or "back"/],
  ['a face index out of range', ({ glb, document }) => (glb.values[document.faces.indices][0] = 4), /the faces has index 4/],
  ['a face of no material', ({ glb, document }) => (glb.values[document.faces.material][0] = 3), /a face is of a material beyond 3/],
  ['an eye at infinity', ({ json }) => (json.nodes[2].matrix[12] = Infinity), /camera "view0" is damaged/],
  ['a camera without angle', ({ json }) => (json.cameras[0].perspective.yfov = -0.5), /camera "view0" is damaged/],
  ['absurdly many entries', ({ json }) => (json.accessors[0].count = 4e9), /its accessor 0 of 4000000000 entries is not inside/],
  ['less than no entries', ({ json }) => (json.accessors[0].count = -1), /its accessor 0 has -1 entries/],
  ['an accessor of nothing', ({ json }) => delete json.accessors[0].bufferView, /its accessor 0 of .* is not inside/],
  ['an odd offset', ({ json }) => Object.assign(json.accessors[0], { byteOffset: 2, count: 1 }), /its accessor 0 of 1 entries is not/],
  ['a sparse accessor', ({ json }) => (json.accessors[0].sparse = { count: 1 }), /its accessor 0 is sparse/],
  ['numbers of no kind', ({ json }) => (json.accessors[0].componentType = 5124), /its accessor 0 has .* component 5124/],
  ['a bufferView beyond the end', ({ json }) => (json.bufferViews[1].byteLength = 1e6), /its bufferView 1 is not inside a buffer/],
  ['a buffer beyond the end', ({ json }) => (json.buffers[0].byteLength *= 2), /its buffer 0 should have \d+ bytes, and \d+ are there/],
  ['a node that is its own child', ({ json }) => (json.nodes[0].children = [0]), /a node of it has children/],
  ['meshes that are none', ({ json }) => (json.meshes = 'none'), /its "meshes" is no list of objects/],
  ['a mesh that is null', ({ json }) => (json.meshes[0] = null), /its "meshes" is no list of objects/],
  ['a node of a mesh that is not there', ({ json }) => (json.nodes[0].mesh = 9), /something in it refers to what is not there/],
  ['another glTF', ({ json }) => (json.asset.version = '1.0'), /cannot be read: .*[Uu]nsupported asset/],
];

describe('A damaged solution', () => {
  it.each(damages)('with %s is refused with a sentence', async (_, damage, sentence) => {
    const glb = room();
    damage(parts(glb));
    const problem = await problemOf(glb.bytes());
    expect(problem).toMatch(/^room\.glb: /);
    expect(problem).toMatch(sentence);
  });

  it('in half floats with no scale to speak of is refused', async () => {
    const glb = room({ halfScale: 2 });
    parts(glb).floorLobes.glossScale = 0;
    expect(await problemOf(glb.bytes())).toMatch(/patch 0's gloss has scale 0, expected a positive number/);
  });

  it('in half floats with an infinite one is refused', async () => {
    const glb = room({ halfScale: 2 });
    glb.values[parts(glb).floorLobes.gloss][0] = 0x7c00;
    expect(await problemOf(glb.bytes())).toMatch(/patch 0's gloss holds a coefficient that is not a number/);
  });
});

describe('A file that is no solution', () => {
  const text = (words: string) => new TextEncoder().encode(words).buffer as ArrayBuffer;

  it('is refused with what it is instead', async () => {
    expect(await problemOf(new ArrayBuffer(0))).toBe('room.glb: is empty');
    expect(await problemOf(text('solid teapot'))).toBe('room.glb: is neither a .glb nor a .gltf file');
    expect(await problemOf(text('<html>not here</html>'))).toBe('room.glb: is neither a .glb nor a .gltf file');
    expect(await problemOf(text('{"asset": {"version":'))).toMatch(/^room\.glb: holds JSON that is damaged: /);
    expect(await problemOf(text('{"asset": {"version": "2.0"}}'))).toMatch(/is a glTF file without lobes/);
  });

  it('is refused wherever it was cut off', async () => {
    const whole = room().bytes();
    for (const length of [1, 11, 19, 20, 500, whole.byteLength - 1]) {
      expect(await problemOf(whole.slice(0, length))).toMatch(/^room\.glb: (is neither|has \d+ bytes, and its header says)/);
    }
  });

  it('is refused if its chunks are wrong', async () => {
    const change = async (at: number, value: number) => {
      const bytes = room().bytes();
      new DataView(bytes).setUint32(at, value, true);
      return problemOf(bytes);
    };
    expect(await change(4, 1)).toMatch(/is a \.glb file of version 1, expected 2/);
    expect(await change(12, 0xffffffff)).toMatch(/one of its chunks ends beyond the file/);
    expect(await change(16, 7)).toMatch(/it has no JSON chunk/);
  });

  it('is refused as a broken gzip file', async () => {
    const packed = new Response(room().bytes()).body!.pipeThrough(new CompressionStream('gzip'));
    const bytes = await new Response(packed).arrayBuffer();
    expect(await problemOf(bytes.slice(0, bytes.byteLength >> 1))).toBe('room.glb: is no whole gzip file');
    new Uint8Array(bytes).fill(0x55, 40, 80);
    expect(await problemOf(bytes)).toBe('room.glb: is no whole gzip file');
  });

  it('is said to be missing, with what the server says', async () => {
    await expect(openResponse(() => new Response('', { status: 404 })))
      .rejects.toThrow('room.glb: room.glb cannot be fetched: the server says 404');
    await expect(openResponse(() => { throw new TypeError('refused'); }))
      .rejects.toThrow('room.glb: room.glb cannot be fetched: does the server still run?');
  });
});

/** Marsaglia's xorshift, so that what fails fails again. */
function random(seed: number): (below: number) => number {
  let s = seed;
  return (below) => {
    s ^= s << 13;
    s ^= s >>> 17;
    s ^= s << 5;
    return (s >>> 0) % below;
  };
}

describe('A file with random damage', () => {
  // Returns, or throws Problem: problemOf passes on everything else. Vitest's timeout ends what hangs.
  it('is read or refused, with bytes flipped', async () => {
    const next = random(1), whole = room().bytes();
    let refused = 0;
    for (let i = 0; i < 600; ++i) {
      const bytes = new Uint8Array(whole.slice(0));
      // Two thirds of the flips into the JSON, where they do most.
      const below = i % 3 === 0 ? bytes.length : 20 + new DataView(whole).getUint32(12, true);
      for (let flips = 1 + next(4); flips > 0; --flips) bytes[next(below)] ^= 1 << next(8);
      if ((await problemOf(bytes.buffer)) !== 'none') ++refused;
    }
    expect(refused).toBeGreaterThan(100);
    expect(refused).toBeLessThan(600);
  }, 30000);

  it('is read or refused, with numbers of its JSON changed', async () => {
    const next = random(2);
    const strange = [-1, 0, 1, 0.5, 2 ** 31, 2 ** 32, 1e300, '7', null, [], {}, true];
    const whole = JSON.stringify(room().json), places = Array.from(whole.matchAll(/(?<=[:,[])-?\d+(\.\d+)?/g));
    let refused = 0;
    for (let i = 0; i < 600; ++i) {
      const { index, 0: number } = places[next(places.length)];
      const value = JSON.stringify(strange[next(strange.length)]);
      const glb = room();
      Object.assign(glb.json, JSON.parse(whole.slice(0, index) + value + whole.slice(index + number.length)));
      if ((await problemOf(glb.bytes())) !== 'none') ++refused;
    }
    expect(refused).toBeGreaterThan(100);
  }, 30000);

  it('is refused, cut off anywhere', async () => {
    const next = random(3), whole = room().bytes();
    for (let i = 0; i < 200; ++i) await expect(open(whole.slice(0, next(whole.byteLength)))).rejects.toThrow(/^room\.glb: /);
  }, 30000);
});
