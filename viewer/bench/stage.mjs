/** A stage without panels (page.ts) that shows a solution, in the browser that the tests use. */
import { readFile } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';
import { build } from 'vite';
import { withScene } from '../../tests/viewer/support/page.mjs';
import { serve } from '../../tests/viewer/support/serve.mjs';

const kHtml = `<!doctype html><link rel="icon" href="data:,">
<style>html,body{margin:0;height:100%}canvas{width:100%;height:100%;display:block}</style>
<canvas></canvas><script type="module" src="page.js"></script>`;

/** Calls `look` with the page once it shows the file; window.lobe is what page.ts puts there. */
export async function withStage(file, look, viewport = { width: 1200, height: 800 }) {
  const { output } = await build({
    configFile: false, logLevel: 'error',
    build: { write: false, target: 'es2022', rollupOptions: { input: fileURLToPath(new URL('page.ts', import.meta.url)) } },
  });
  const site = await serve({}, { 'index.html': kHtml, 'page.js': output[0].code, 'solution.glb': await readFile(file) });
  try {
    return await withScene(site.address, look, viewport);
  } finally {
    await site.close();
  }
}
