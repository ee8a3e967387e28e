/** A page of this folder in a browser without a window, its GPU in software (SwiftShader). CHROMIUM: its program. */
import { readFile } from 'node:fs/promises';
import http from 'node:http';
import { build } from 'esbuild';
import { chromium } from 'playwright-core';

export async function openPage(solution, { width = 1200, height = 800, before = '' } = {}) {
  const { outputFiles } = await build({
    entryPoints: [new URL('page.ts', import.meta.url).pathname], bundle: true, write: false, format: 'esm', target: 'es2022',
  });
  const html = `<!doctype html><style>html,body{margin:0;height:100%}canvas{width:100%;height:100%;display:block}</style>
    <canvas></canvas><script>${before}</script><script type="module" src="page.js"></script>`;
  const server = http.createServer(async (request, response) => {
    if (request.url === '/') response.setHeader('Content-Type', 'text/html').end(html);
    else if (request.url === '/page.js') response.setHeader('Content-Type', 'text/javascript').end(outputFiles[0].text);
    else if (request.url === '/solution.glb') response.end(await readFile(solution));
    else response.writeHead(404).end();
  });
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--no-sandbox'],
  });
  const page = await browser.newPage({ viewport: { width, height } });
  const messages = [];
  page.on('console', (m) => messages.push(m.text()));
  page.on('pageerror', (e) => messages.push(e.message));
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  await page.evaluate(async () => Object.assign(window, await window.open_('/solution.glb')));
  return { page, messages, close: async () => { await browser.close(); server.close(); } };
}
