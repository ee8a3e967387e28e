/** All that tests use of Node.js: its whole types would let src/ use what browsers lack. */
declare module 'node:fs' {
  export function readFileSync(path: URL): Uint8Array<ArrayBuffer>;
}
