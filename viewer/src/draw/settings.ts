/**
 * How the scene is shown. Everything here may change between two frames: exposure, curve, scale and backs for a uniform;
 * the degree for all glossy lobes anew, and mirrors' probes; a quantity and the wires for what is sent at first.
 */
import { kMostDegree } from '../solution/solution';

export interface Settings {
  /** Stops: radiance is shown times 2^exposure, as `lobe render --exposure`. */
  exposure: number;
  curve: ToneCurve;
  /** Null: the picture. */
  falseColour: FalseColour | null;
  /** Lobes are shown cut at this degree, their flux kept; whole if theirs is lower. */
  degree: number;
  /** Edges of the elements. */
  wireframe: boolean;
  /** Look through the black backs of walls, to see a room from outside. */
  seeThroughBacks: boolean;
}

export type ToneCurve = 'srgb' | 'reinhard' | 'filmic';
export const toneCurves: readonly ToneCurve[] = ['srgb', 'reinhard', 'filmic'];

export type Quantity =
  | 'radiance' | 'irradiance' | 'density' | 'degree' | 'negative' | 'hidden' | 'kind';

/** A quantity in colours. What has a scale is shown from `low` to `high`, in its own unit. */
export interface FalseColour {
  quantity: Quantity;
  low: number;
  high: number;
  logarithmic: boolean;
}

export const defaultSettings: Settings = {
  exposure: 0,
  curve: 'srgb',
  falseColour: null,
  degree: kMostDegree,
  wireframe: false,
  seeThroughBacks: false,
};
