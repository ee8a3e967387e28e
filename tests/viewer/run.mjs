// The browser tests, all in one process and one browser:
//   LOBE_PROGRAM=build/release/app/lobe LOBE_VIEWER_BUNDLE=build/release/viewer LOBE_VIEWER_WORK=/tmp/viewer \
//     node --test-reporter=spec tests/viewer/run.mjs [NAME ...]
// NAME: the beginning of a test file's name, such as "picture". Pictures that tests saw stay in LOBE_VIEWER_WORK.
import { readdirSync } from 'node:fs';

const names = process.argv.slice(2);
const files = readdirSync(new URL('.', import.meta.url)).filter((name) => name.endsWith('.test.mjs')).sort();
for (const file of files) {
  if (names.length === 0 || names.some((name) => file.startsWith(name))) await import(`./${file}`);
}
