/**
 * A view as the end of an address: #eye=…&target=…&node=… (README.md lists it). What is garbage is left out, so that
 * a link that was cut or mistyped shows what it can.
 */
import { Vector3 } from 'three';
import { toneCurves, type FalseColour, type Quantity, type Settings } from '../draw/settings';
import { kMostDegree } from '../solution/solution';
import type { Pose } from './stage';

export const quantities: readonly Quantity[] = [
  'radiance', 'irradiance', 'density', 'degree', 'negative', 'hidden', 'kind'];

export interface Address {
  pose?: Pose;
  /** Name of a camera; a pose beside it wins. */
  camera?: string;
  node?: number;
  compare?: number;
  /** A quantity alone has the range that suits the scene. */
  show?: { quantity: Quantity; low?: number; high?: number; logarithmic?: boolean };
  settings: Partial<Omit<Settings, 'falseColour'>>;
}

const kExposure = 30;

function number(text: string | undefined, low: number, high: number): number | undefined {
  if (text === undefined || text.trim() === '') return undefined;
  const value = Number(text);
  return value >= low && value <= high ? value : undefined;
}

function vector(text: string | undefined): Vector3 | undefined {
  const values = (text ?? '').split(',').map((word) => number(word, -1e9, 1e9));
  if (values.length !== 3 || values.includes(undefined)) return undefined;
  return new Vector3(...(values as [number, number, number]));
}

function whole(text: string | undefined, high: number): number | undefined {
  const value = number(text, 0, high);
  return Number.isInteger(value) ? value : undefined;
}

function words(hash: string): Map<string, string> {
  const out = new Map<string, string>();
  for (const pair of hash.replace(/^#/, '').split('&')) {
    const [name, ...rest] = pair.split('=');
    if (rest.length === 0) continue;
    try {
      out.set(name, decodeURIComponent(rest.join('=')));
    } catch {
      // Half an escape: as if it was not there.
    }
  }
  return out;
}

export function parseAddress(hash: string): Address {
  const get = words(hash);
  const address: Address = { settings: {} };

  const eye = vector(get.get('eye')), target = vector(get.get('target'));
  if (eye && target && eye.distanceTo(target) > 0) {
    let up = vector(get.get('up')) ?? new Vector3(0, 1, 0);
    if (up.length() === 0) up = new Vector3(0, 1, 0);
    address.pose = { eye, target, up: up.normalize(), fov: number(get.get('fov'), 1, 170) ?? 45 };
  }
  address.camera = get.get('camera');
  address.node = whole(get.get('node'), Number.MAX_SAFE_INTEGER);
  address.compare = whole(get.get('compare'), Number.MAX_SAFE_INTEGER);

  const { settings } = address;
  const exposure = number(get.get('exposure'), -kExposure, kExposure);
  if (exposure !== undefined) settings.exposure = exposure;
  const curve = toneCurves.find((c) => c === get.get('curve'));
  if (curve) settings.curve = curve;
  const degree = whole(get.get('degree'), kMostDegree);
  if (degree !== undefined) settings.degree = degree;
  if (get.get('wireframe') === '1') settings.wireframe = true;
  if (get.get('backs') === 'through') settings.seeThroughBacks = true;

  const quantity = quantities.find((q) => q === get.get('show'));
  if (quantity) {
    const low = number(get.get('low'), -1e30, 1e30), high = number(get.get('high'), -1e30, 1e30);
    const scale = get.get('scale');
    address.show = { quantity };
    if (low !== undefined && high !== undefined && low < high) Object.assign(address.show, { low, high });
    if (scale === 'log' || scale === 'linear') address.show.logarithmic = scale === 'log';
  }
  for (const key of ['camera', 'node', 'compare'] as const) if (address[key] === undefined) delete address[key];
  return address;
}

const digits = (value: number) => String(Number(value.toPrecision(6)));

/** Two places, or a direction from the origin: to a hundred-thousandth of what is between, wherever they are. */
function places(...ends: Vector3[]): string[] {
  const apart = ends.length > 1 ? ends[0].distanceTo(ends[1]) : ends[0].length();
  const decimals = Math.min(20, Math.max(0, Math.ceil(5 - Math.log10(apart))));
  return ends.map((v) => v.toArray().map((x) => String(Number(x.toFixed(decimals)) + 0)).join(','));
}

export interface Shown {
  pose: Pose;
  settings: Readonly<Settings>;
  node: number | null;
  compare: number | null;
  /** The solution's highest degree: from there on lobes are whole, and nothing is said. */
  lMax: number;
}

export function formatAddress({ pose, settings, node, compare, lMax }: Shown): string {
  const [eye, target] = places(pose.eye, pose.target);
  const parts = [`eye=${eye}`, `target=${target}`];
  if (pose.up.distanceTo(new Vector3(0, 1, 0)) > 1e-6) parts.push(`up=${places(pose.up)[0]}`);
  parts.push(`fov=${digits(pose.fov)}`);
  if (node !== null) parts.push(`node=${node}`);
  if (compare !== null) parts.push(`compare=${compare}`);
  parts.push(`exposure=${digits(settings.exposure)}`);
  if (settings.curve !== 'srgb') parts.push(`curve=${settings.curve}`);
  if (settings.degree < lMax) parts.push(`degree=${settings.degree}`);
  if (settings.falseColour) parts.push(...showing(settings.falseColour));
  if (settings.wireframe) parts.push('wireframe=1');
  if (settings.seeThroughBacks) parts.push('backs=through');
  return `#${parts.join('&')}`;
}

function showing({ quantity, low, high, logarithmic }: FalseColour): string[] {
  return [`show=${quantity}`, `low=${digits(low)}`, `high=${digits(high)}`, `scale=${logarithmic ? 'log' : 'linear'}`];
}
