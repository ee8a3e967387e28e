// All browser tests in one process and one browser; run.sh says what they need. Arguments: which, by the beginnings of
// their files' names.
import { readdirSync } from 'node:fs';
import { after } from 'node:test';
import { closeBrowser } from './support/page.mjs';

const names = process.argv.slice(2);
const files = readdirSync(new URL('.', import.meta.url)).filter((name) => name.endsWith('.test.mjs')).sort();
const chosen = files.filter((file) => names.length === 0 || names.some((name) => file.startsWith(name)));
if (chosen.length === 0) throw new Error(`no browser test begins with ${names.join(' or ')}`);
for (const file of chosen) await import(`./${file}`);
after(closeBrowser);
