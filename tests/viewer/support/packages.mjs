// The viewer's own packages (viewer/package-lock.json), so that there is one place for them.
import { createRequire } from 'node:module';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

export const root = fileURLToPath(new URL('../../../', import.meta.url));
const require = createRequire(path.join(root, 'viewer/package.json'));

export const { chromium } = require('playwright-core');
export const { PNG } = require('pngjs');
/** Folder of three.js, as it was published. */
export const three = path.join(root, 'viewer/node_modules/three');
