// The viewer's own packages (viewer/package-lock.json), so that there is one place for them.
import { createRequire } from 'node:module';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

export const root = fileURLToPath(new URL('../../../', import.meta.url));
const require = createRequire(path.join(root, 'viewer/package.json'));

export const { chromium } = require('playwright-core');
export const { PNG } = require('pngjs');
const { buildSync } = require('esbuild');
/** Folder of three.js, as it was published. */
export const three = path.join(root, 'viewer/node_modules/three');

/** A module of the viewer's sources or unit tests, to be used here: its path in viewer/. */
export function source(file) {
  const { outputFiles } = buildSync({ entryPoints: [path.join(root, 'viewer', file)], bundle: true, write: false, format: 'esm' });
  return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString('base64')}`);
}
