import { Problem } from './problem';
import type { GlossKind, Material, Rgb } from './solution';

/** What the viewer reads of an entry of the document's `materials`. */
export interface GltfMaterial {
  name?: string;
  doubleSided?: boolean;
  emissiveFactor?: number[];
  pbrMetallicRoughness?: { baseColorFactor?: number[]; metallicFactor?: number };
  extensions?: {
    KHR_materials_emissive_strength?: { emissiveStrength?: number };
    KHR_materials_ior?: { ior?: number };
    KHR_materials_specular?: { specularFactor?: number; specularColorFactor?: number[] };
    KHR_materials_transmission?: { transmissionFactor?: number };
    KHR_materials_volume?: { thicknessFactor?: number; attenuationColor?: number[]; attenuationDistance?: number };
    KHR_materials_diffuse_transmission?: unknown;
  };
}

/** An entry of `materials` in the document's LOBE_directional_radiance (format.md#document). */
export interface LobeMaterial {
  kind?: string;
  error?: number;
  albedo?: number[];
}

const kinds: readonly GlossKind[] = ['none', 'lobe', 'sharp', 'mirror'];

const rgb = (values: number[] | undefined, otherwise: Rgb): Rgb =>
  values && values.length >= 3 ? [values[0], values[1], values[2]] : otherwise;

const map = (f: (channel: 0 | 1 | 2) => number): Rgb => [f(0), f(1), f(2)];

/** attenuationColor^(length / attenuationDistance) is exp(-extinction · length). No thickness: a pane, which has no inside. */
function extinctionOf(volume: NonNullable<GltfMaterial['extensions']>['KHR_materials_volume']): Rgb {
  const { thicknessFactor = 0, attenuationColor, attenuationDistance = Infinity } = volume ?? {};
  if (!(thicknessFactor > 0)) return [0, 0, 0];
  const colour = rgb(attenuationColor, [1, 1, 1]);
  // Black takes all there is: as much as a float can say will do.
  return map((c) => -Math.log(Math.max(colour[c], 1e-30)) / attenuationDistance + 0);
}

export function readMaterial(index: number, gltf: GltfMaterial, lobe: LobeMaterial): Material {
  const kind = kinds.find((k) => k === lobe.kind);
  if (!kind) throw new Problem(`material ${index} is of kind "${lobe.kind}", expected one of ${kinds.join(', ')}`);
  const pbr = gltf.pbrMetallicRoughness ?? {}, extensions = gltf.extensions ?? {};
  const base = rgb(pbr.baseColorFactor, [1, 1, 1]);
  const metallic = pbr.metallicFactor ?? 1;
  const strength = extensions.KHR_materials_emissive_strength?.emissiveStrength ?? 1;
  const emissive = rgb(gltf.emissiveFactor, [0, 0, 0]);

  // glTF 2.0, appendix B, with KHR_materials_ior and KHR_materials_specular.
  const ior = extensions.KHR_materials_ior?.ior ?? 1.5;
  const normal = ior === 0 ? 1 : ((ior - 1) / (ior + 1)) ** 2;
  const specular = extensions.KHR_materials_specular ?? {};
  const factor = specular.specularFactor ?? 1, tint = rgb(specular.specularColorFactor, [1, 1, 1]);
  const f0 = map((c) => metallic * base[c] + (1 - metallic) * factor * Math.min(1, normal * tint[c]));
  const f90 = map(() => metallic + (1 - metallic) * factor);

  const through = (extensions.KHR_materials_transmission?.transmissionFactor ?? 0) * (1 - metallic);
  const material: Material = {
    name: gltf.name ?? `material ${index}`,
    kind,
    error: lobe.error ?? 0,
    emission: map((c) => emissive[c] * strength),
    doubleSided:
      gltf.doubleSided === true || extensions.KHR_materials_diffuse_transmission !== undefined,
    albedo: lobe.albedo ? rgb(lobe.albedo, [0, 0, 0]) : null,
    specular: { f0, f90 },
    transmission: through > 0 ? map((c) => through * base[c]) : null,
    extinction: extinctionOf(extensions.KHR_materials_volume),
  };
  const { emission, albedo, transmission, extinction, error } = material;
  if (![error, ...emission, ...(albedo ?? []), ...f0, ...f90, ...(transmission ?? []), ...extinction].every(Number.isFinite)) {
    throw new Problem(`material "${material.name}" holds a value that is not a number`);
  }
  return material;
}
