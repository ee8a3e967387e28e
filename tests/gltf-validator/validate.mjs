// Validates the glTF files given (folders: every .glb and .gltf inside) with the Khronos validator. Prints
// errors and warnings; exit code 1 if any file has an error or there was nothing to check.
import { readFileSync, readdirSync, statSync } from 'node:fs';
import path from 'node:path';
import validator from 'gltf-validator';

const files = process.argv.slice(2).flatMap((name) =>
  statSync(name).isDirectory()
    ? readdirSync(name).filter((f) => /\.(glb|gltf)$/.test(f)).sort().map((f) => path.join(name, f))
    : [name]);
if (files.length === 0) {
  console.error('validate.mjs: no .glb or .gltf file given or found');
  process.exit(1);
}

let failed = false;
for (const file of files) {
  const report = await validator.validateBytes(new Uint8Array(readFileSync(file)), {
    uri: path.basename(file),
    maxIssues: 0,   // no limit: infos would use it up before the errors come
    // Told once per accessor of an extension that the validator does not know.
    ignoredIssues: ['UNSUPPORTED_EXTENSION', 'UNUSED_OBJECT'],
    externalResourceFunction: async (uri) =>
      new Uint8Array(readFileSync(path.resolve(path.dirname(file), decodeURIComponent(uri)))),
  });
  const { numErrors, numWarnings, numInfos, messages } = report.issues;
  console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} infos`);
  for (const m of messages.filter((m) => m.severity < 2).slice(0, 50)) {
    console.log(`  ${m.severity === 0 ? 'error' : 'warning'} ${m.code} at ${m.pointer ?? m.offset}: ${m.message}`);
  }
  failed ||= numErrors > 0;
}
process.exit(failed ? 1 : 0);
