import type { Quantity } from '../draw/settings';

export interface QuantityText {
  /** In the menu. */
  name: string;
  unit: string;
  /** Kinds and not numbers: a list instead of a scale. */
  kinds?: boolean;
}

export const quantityTexts: Record<Quantity, QuantityText> = {
  radiance: { name: 'luminance towards the eye', unit: 'W/(m² sr)' },
  irradiance: { name: 'irradiance', unit: 'W/m²' },
  density: { name: 'density of nodes', unit: '1/m²' },
  degree: { name: 'degree of lobes', unit: 'l_max' },
  negative: { name: 'negative part', unit: 'of the flux, whole lobes' },
  hidden: { name: 'hidden nodes', unit: '', kinds: true },
  kind: { name: 'kind of gloss', unit: '', kinds: true },
};
