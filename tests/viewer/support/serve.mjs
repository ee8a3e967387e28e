// A static web server, as dull as those that exports are put on.
import { createServer } from 'node:http';
import { readFile } from 'node:fs/promises';
import path from 'node:path';

const types = {
  '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.json': 'application/json', '.glb': 'model/gltf-binary',
};

/**
 * Serves `folders` ({'/at/': folder}), and before them `files` ({'name': bytes, a string, or an object for JSON}).
 * Returns its address and how to end it.
 */
export async function serve(folders, files = {}) {
  const find = async (name) => {
    if (name in files) {
      const file = files[name];
      return typeof file === 'string' || file instanceof Uint8Array ? file : JSON.stringify(file);
    }
    for (const [at, folder] of Object.entries(folders)) {
      const whole = path.join(folder, name.slice(at.length - 1));
      if (`/${name}`.startsWith(at) && whole.startsWith(folder)) return readFile(whole).catch(() => null);
    }
    return null;
  };
  const server = createServer(async (request, response) => {
    const name = decodeURIComponent(new URL(request.url, 'http://server').pathname).slice(1) || 'index.html';
    const body = await find(name);
    response.writeHead(body === null ? 404 : 200, { 'Content-Type': types[path.extname(name)] ?? 'application/octet-stream' });
    response.end(body ?? 'not here');
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return {
    address: `http://127.0.0.1:${server.address().port}/`,
    close: () => new Promise((resolve) => {
      server.close(resolve);
      server.closeAllConnections();
    }),
  };
}
