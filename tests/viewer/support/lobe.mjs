// The real program, and two scenes solved with it: coarse, to be quick, but glossy, with contacts and refined.
import { execFileSync, spawn } from 'node:child_process';
import { mkdirSync } from 'node:fs';
import path from 'node:path';
import { root } from './packages.mjs';
import { writePng } from './pictures.mjs';

const fromEnvironment = (name) => {
  if (!process.env[name]) throw new Error(`${name} is not set; see tests/viewer/run.sh`);
  return process.env[name];
};

const program = fromEnvironment('LOBE_PROGRAM');
/** The built page. */
export const bundle = fromEnvironment('LOBE_VIEWER_BUNDLE');
/** Solutions, reference pictures, and what a failing test saw. */
export const work = fromEnvironment('LOBE_VIEWER_WORK');
mkdirSync(work, { recursive: true });

/** Puts a picture into the working folder, to be looked at; its file. */
export function keep(name, picture) {
  const file = path.join(work, `${name}.png`);
  writePng(file, picture);
  return file;
}

/** Runs lobe to its end; standard output. */
export const lobe = (...words) => execFileSync(program, words, { encoding: 'utf8', maxBuffer: 1 << 26 });

export const scene = (name) => path.join(root, 'tests/scenes', `${name}.glb`);

const coarse = ['--edge', '0.8', '--links', '128', '--light-samples', '16', '--lmax', '12', '--refine-error', '20'];
const solved = new Map();

/** File of a solution of tests/scenes/NAME.glb, or of another scene that is to have this name. */
export function solution(name, from = scene(name)) {
  if (!solved.has(name)) {
    const file = path.join(work, `${name}.solution.glb`);
    lobe('solve', from, '-o', file, ...coarse, '--quiet');
    solved.set(name, file);
  }
  return solved.get(name);
}

/** Serves a solution as users do, by `lobe view`: its address, and how to end it. */
export async function view(file) {
  const child = spawn(program, ['view', file, '--no-browser', '--port', '0', '--viewer', bundle, '--quiet']);
  const end = () => child.kill();
  process.once('exit', end);
  let errors = '';
  child.stderr.on('data', (text) => (errors += text));
  const ended = new Promise((resolve) => child.once('close', resolve));
  const address = await new Promise((resolve, reject) => {
    let out = '';
    child.stdout.on('data', (text) => {
      out += text;
      const found = out.match(/http:\S+/);
      if (found) resolve(found[0]);
    });
    child.once('error', reject);
    ended.then((code) => reject(new Error(`lobe view ended with ${code}: ${errors}`)));
  });
  return {
    address,
    /** Interrupts it, and says with which code it went. */
    async close() {
      child.kill('SIGINT');
      process.off('exit', end);
      return ended;
    },
  };
}
