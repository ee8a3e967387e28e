/** A lobe as a surface: distance from the node = radiance's magnitude towards there. Arrays alone, no GPU. */
import { PolarGrid } from '../sh/polar_grid';
import { kLuminance } from '../solution/luminance';
import type { Lobe } from './lobe';

export interface Surface {
  /** Local frame, in units of radiance, W m⁻² sr⁻¹; three floats a vertex. */
  positions: Float32Array;
  /** Radiance of each vertex, three floats; below zero where the lobe is. */
  radiance: Float32Array;
  /** Luminance of each vertex, with its sign. */
  luminance: Float32Array;
  triangles: Uint32Array;
  /** Pairs of vertices: parallels and meridians, so that a shape is seen whatever its colour. */
  lines: Uint32Array;
}

interface Shape {
  grid: PolarGrid;
  triangles: Uint32Array;
  lines: Uint32Array;
}

const shapes = new Map<number, Shape>();

/** Rings from the pole to the horizon, fine enough for the oscillations of a degree. */
function shapeFor(lMax: number): Shape {
  const known = shapes.get(lMax);
  if (known) return known;
  // Multiples of 24, so that the lines at every 15 degrees of azimuth and every quarter of θ are there.
  const rings = 24 * Math.max(2, Math.ceil(lMax / 10)), spokes = 2 * rings;
  const sines = Array.from({ length: rings + 1 }, (_, i) => Math.sin((Math.PI * i) / (2 * rings)));
  const triangles: number[] = [], lines: number[] = [];
  const at = (ring: number, spoke: number) => ring * spokes + (spoke % spokes);
  for (let ring = 0; ring < rings; ++ring) {
    for (let spoke = 0; spoke < spokes; ++spoke) {
      triangles.push(at(ring, spoke), at(ring + 1, spoke), at(ring + 1, spoke + 1));
      // On the pole all spokes are one point.
      if (ring > 0) triangles.push(at(ring, spoke), at(ring + 1, spoke + 1), at(ring, spoke + 1));
      if (spoke % (spokes / 12) === 0) lines.push(at(ring, spoke), at(ring + 1, spoke));
      if ((ring + 1) % (rings / 6) === 0) lines.push(at(ring + 1, spoke), at(ring + 1, spoke + 1));
    }
  }
  const shape = {
    grid: new PolarGrid(lMax, sines, spokes), triangles: Uint32Array.from(triangles), lines: Uint32Array.from(lines),
  };
  shapes.set(lMax, shape);
  return shape;
}

/** `fineness`: the degree whose oscillations the mesh can show, so that cuts of one lobe share it. */
export function surfaceOf(lobe: Lobe, fineness = lobe.lMax): Surface {
  const { grid, triangles, lines } = shapeFor(fineness);
  const channels = lobe.channels.map((z) => grid.evaluate(z));
  const count = channels[0].length;
  const positions = new Float32Array(3 * count), radiance = new Float32Array(3 * count);
  const luminance = new Float32Array(count);
  for (let i = 0; i < count; ++i) {
    let sum = 0;
    for (let c = 0; c < 3; ++c) {
      radiance[3 * i + c] = channels[c][i];
      sum += kLuminance[c] * channels[c][i];
    }
    luminance[i] = sum;
    const sine = grid.sines[Math.floor(i / grid.spokes)], phi = grid.azimuth(i % grid.spokes);
    const length = Math.abs(sum);
    positions[3 * i] = length * sine * Math.cos(phi);
    positions[3 * i + 1] = length * sine * Math.sin(phi);
    positions[3 * i + 2] = length * Math.sqrt(Math.max(0, 1 - sine * sine));
  }
  return { positions, radiance, luminance, triangles, lines };
}
