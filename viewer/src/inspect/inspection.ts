/** All that the viewer says of a node: a superset of what `lobe inspect --json` says, under its names. */
import { frameOf, toWorld, type Frame, type Vec3 } from '../sh/frame';
import { coefficientCount, toHemisphere } from '../sh/zernike';
import { findNode, type GlossKind, type Patch, type Rgb, type Side, type Solution } from '../solution/solution';
import { errorOfCut, measureLobe, spectrumOf, type Figures } from './figures';
import { cutLobe, lobeOfNode, type Lobe } from './lobe';

export interface Inspection {
  node: number;
  patch: Patch;
  surface: string;
  material: string;
  kind: GlossKind;
  side: Side;
  hidden: boolean;
  /** Metres, world. */
  position: Vec3;
  frame: Frame;
  /** Null: the patch is black. */
  whole: Lobe | null;
  /** `whole` at the degree that is shown. */
  shown: Lobe | null;
  figures: Figures | null;
  /** Energy of `whole` by degree. */
  spectrum: number[];
  /** Relative, of `shown` against `whole`. */
  error: number;
}

/** Null if there is no such node. `degree`: that lobes are shown at. */
export function inspectNode(solution: Solution, node: number, degree: number): Inspection | null {
  const found = Number.isInteger(node) ? findNode(solution, node) : null;
  if (!found) return null;
  const { patch, local } = found;
  const vector = (a: Float32Array): Vec3 => [a[3 * local], a[3 * local + 1], a[3 * local + 2]];
  const material = solution.materials[patch.material];
  const whole = lobeOfNode(patch, local), shown = whole && cutLobe(whole, degree);
  return {
    node, patch,
    surface: solution.surfaceNames[patch.surface],
    material: material.name,
    kind: material.kind,
    side: patch.side,
    hidden: patch.hidden?.[local] === 1,
    position: vector(patch.positions),
    frame: frameOf(vector(patch.normals)),
    whole, shown,
    figures: shown && measureLobe(shown),
    spectrum: whole ? spectrumOf(whole) : [],
    error: whole ? errorOfCut(whole, degree) : 0,
  };
}

/** One lobe as JSON: the members of `lobe inspect --json` that a viewer can know, and a few more. Base and gloss are
 *  one here, so there is one `l_max`. */
export interface LobeJson
  extends Pick<Inspection, 'node' | 'surface' | 'material' | 'kind' | 'side' | 'hidden' | 'position' | 'frame'> {
  /** Of the node; null: black. */
  l_max: number | null;
  /** At which everything below was said. */
  degree: number | null;
  flux: Rgb;
  peak: {
    luminance: number;
    radiance: Rgb;
    theta_degrees: number;
    phi_degrees: number;
    direction_local: Vec3;
    direction_world: Vec3;
  } | null;
  negative_fraction: number;
  /** By flux (conventions.md), where negative_fraction is by magnitude. */
  negative_flux_fraction: number;
  /** Relative, L2 under the cosine, against the whole lobe. */
  relative_error: number;
  /** Energy by degree of the whole lobe, channels added. */
  spectrum: number[];
  /** Over H, a row per coefficient, three channels. */
  coefficients: Rgb[];
}

export function toJson(i: Inspection): LobeJson {
  const figures = i.figures;
  return {
    node: i.node, surface: i.surface, material: i.material, kind: i.kind, side: i.side, hidden: i.hidden,
    position: i.position, frame: i.frame,
    l_max: i.whole?.lMax ?? null,
    degree: i.shown?.lMax ?? null,
    flux: figures?.flux ?? [0, 0, 0],
    peak: figures && {
      luminance: figures.peak.luminance,
      radiance: figures.peak.radiance,
      theta_degrees: figures.peak.thetaDegrees,
      phi_degrees: figures.peak.phiDegrees,
      direction_local: figures.peak.direction,
      direction_world: toWorld(i.frame, figures.peak.direction),
    },
    negative_fraction: figures?.negativeFraction ?? 0,
    negative_flux_fraction: figures?.negative ?? 0,
    relative_error: i.error,
    spectrum: i.spectrum,
    coefficients: i.shown ? hemisphereRows(i.shown) : [],
  };
}

function hemisphereRows(lobe: Lobe): Rgb[] {
  const channels = lobe.channels.map((z) => {
    const h = new Float64Array(coefficientCount(lobe.lMax));
    toHemisphere(lobe.lMax, z, h);
    return h;
  });
  return Array.from(channels[0], (_, k) => [channels[0][k], channels[1][k], channels[2][k]]);
}
