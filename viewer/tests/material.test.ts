import { describe, expect, it } from 'vitest';
import { readMaterial, type GltfMaterial } from '../src/solution/material';

const read = (gltf: GltfMaterial, lobe = {}) => readMaterial(4, gltf, { kind: 'none', ...lobe });

const close = (actual: readonly number[] | null, expected: number[]) =>
  expected.forEach((value, c) => expect(actual![c]).toBeCloseTo(value, 12));

describe('A material', () => {
  it('emits its factor times its strength', () => {
    const extensions = { KHR_materials_emissive_strength: { emissiveStrength: 8 } };
    close(read({ emissiveFactor: [1, 0.5, 0.25], extensions }).emission, [8, 4, 2]);
    close(read({ emissiveFactor: [1, 0.5, 0.25] }).emission, [1, 0.5, 0.25]);
    close(read({}).emission, [0, 0, 0]);
  });

  it('reflects as glTF says: metals their colour, dielectrics by their index, both full at grazing angles', () => {
    const metal = read({ pbrMetallicRoughness: { baseColorFactor: [0.9, 0.6, 0.3, 1] } }).specular;
    close(metal.f0, [0.9, 0.6, 0.3]);
    close(metal.f90, [1, 1, 1]);
    const plastic = read({ pbrMetallicRoughness: { metallicFactor: 0 } }).specular;
    close(plastic.f0, [0.04, 0.04, 0.04]);
    close(plastic.f90, [1, 1, 1]);
    const diamond = read({ pbrMetallicRoughness: { metallicFactor: 0 }, extensions: { KHR_materials_ior: { ior: 2.4 } } });
    close(diamond.specular.f0, Array(3).fill((1.4 / 3.4) ** 2));
  });

  it('keeps what KHR_materials_specular takes and tints', () => {
    const extensions = {
      KHR_materials_specular: { specularFactor: 0.5, specularColorFactor: [1, 0.5, 100] }, KHR_materials_ior: { ior: 1.5 },
    };
    const { f0, f90 } = read({ pbrMetallicRoughness: { metallicFactor: 0 }, extensions }).specular;
    close(f0, [0.02, 0.01, 0.5]);
    close(f90, [0.5, 0.5, 0.5]);
  });

  it('mixes metal and dielectric', () => {
    const { f0 } = read({ pbrMetallicRoughness: { metallicFactor: 0.25, baseColorFactor: [0.8, 0.4, 0, 1] } }).specular;
    close(f0, [0.2 + 0.03, 0.1 + 0.03, 0.03]);
  });

  it('is glass if it transmits, in its colour', () => {
    const glass = { metallicFactor: 0, baseColorFactor: [1, 0.5, 0.25, 1] };
    const extensions = { KHR_materials_transmission: { transmissionFactor: 0.5 } };
    close(read({ pbrMetallicRoughness: glass, extensions }).transmission, [0.5, 0.25, 0.125]);
    expect(read({ pbrMetallicRoughness: glass }).transmission).toBeNull();
    expect(read({ pbrMetallicRoughness: { ...glass, metallicFactor: 1 }, extensions }).transmission).toBeNull();
  });

  it('dims by length inside of bodies, not in panes', () => {
    const volume = { attenuationColor: [0.25, 1, 0.5], attenuationDistance: 0.5 };
    const read1 = (thicknessFactor: number) =>
      read({ extensions: { KHR_materials_volume: { ...volume, thicknessFactor } } }).extinction;
    close(read1(1), [4 * Math.LN2, 0, 2 * Math.LN2]);
    close(read1(0), [0, 0, 0]);
    close(read({}).extinction, [0, 0, 0]);
  });

  it('has two sides if it says so, and if light comes through it', () => {
    expect(read({}).doubleSided).toBe(false);
    expect(read({ doubleSided: true }).doubleSided).toBe(true);
    expect(read({ extensions: { KHR_materials_diffuse_transmission: {} } }).doubleSided).toBe(true);
  });

  it('has name, kind, error and albedo, as far as the file says', () => {
    expect(read({ name: 'tin' }, { kind: 'mirror', error: 0.5, albedo: [0.1, 0.2, 0.3] })).toMatchObject(
      { name: 'tin', kind: 'mirror', error: 0.5, albedo: [0.1, 0.2, 0.3] });
    expect(read({})).toMatchObject({ name: 'material 4', error: 0, albedo: null });
  });

  it('of an unknown kind is refused with the kinds there are', () => {
    expect(() => read({}, { kind: 'velvet' })).toThrow('material 4 is of kind "velvet", expected one of none, lobe');
  });

  it('with a number that is none is refused by name', () => {
    expect(() => read({ name: 'tin', emissiveFactor: [1, 1, 1], extensions: { KHR_materials_emissive_strength: { emissiveStrength: NaN } } }))
      .toThrow('material "tin" holds a value that is not a number');
  });
});
