import { GLTFLoader, type GLTF, type GLTFLoaderPlugin, type GLTFParser } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { checkContainer } from './container';
import { Problem } from './problem';
import { checkDocument, kExtension, readSolution, type Parser } from './read';
import type { Solution } from './solution';

/**
 * The plugin for three's GLTFLoader: `gltf.userData.lobe` becomes a Solution. Plain three.js pages may use it too:
 *
 *     loader.register((parser) => new DirectionalRadiancePlugin(parser, 'solution.glb'));
 */
export class DirectionalRadiancePlugin implements GLTFLoaderPlugin {
  readonly name = kExtension;
  constructor(private readonly parser: GLTFParser, private readonly title: string) {}

  async afterRoot(gltf: GLTF): Promise<void> {
    gltf.userData.lobe = await readSolution(this.parser as unknown as Parser, this.title);
  }
}

/** What `lobe view` and `lobe export` put beside the page. */
export interface View {
  solution: string;
  title: string;
}

async function fetchOrSay(address: string): Promise<Response> {
  let response: Response;
  try {
    response = await fetch(address);
  } catch {
    throw new Problem(`${address} cannot be fetched: does the server still run?`);
  }
  if (!response.ok) throw new Problem(`${address} cannot be fetched: the server says ${response.status}`);
  return response;
}

/** Which solution to show: `?solution=ADDRESS`, or what view.json beside the page says. */
export async function findView(search: string): Promise<View> {
  const asked = new URLSearchParams(search).get('solution');
  if (asked) return { solution: asked, title: asked.split('/').pop() ?? asked };
  const response = await fetchOrSay('view.json');
  let view: Partial<View>;
  try {
    view = (await response.json()) as Partial<View>;
  } catch {
    throw new Problem('view.json is not JSON; `lobe export` writes a good one');
  }
  if (typeof view.solution !== 'string') throw new Problem('view.json names no "solution"');
  return { solution: view.solution, title: typeof view.title === 'string' ? view.title : view.solution };
}

/** Some servers unpack a .gz on the way, so that its name does not tell. */
function isGzip(bytes: ArrayBuffer): boolean {
  const [first, second] = new Uint8Array(bytes, 0, Math.min(2, bytes.byteLength));
  return first === 0x1f && second === 0x8b;
}

async function unpack(bytes: ArrayBuffer): Promise<ArrayBuffer> {
  try {
    const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip') as never);
    return await new Response(plain as ReadableStream).arrayBuffer();
  } catch {
    throw new Problem('is no whole gzip file');
  }
}

/** Fetches a file, telling which share of it is here (0..1; undefined: unknown). What is gzipped is unpacked. */
async function fetchBytes(address: string, onProgress: (share?: number) => void): Promise<ArrayBuffer> {
  const response = await fetchOrSay(address);
  const total = Number(response.headers.get('Content-Length')) || undefined;
  let here = 0;
  const counted = response.body!.pipeThrough(
    new TransformStream<Uint8Array, Uint8Array>({
      transform(chunk, controller) {
        here += chunk.byteLength;
        onProgress(total && Math.min(1, here / total));
        controller.enqueue(chunk);
      },
    }),
  );
  let bytes: ArrayBuffer;
  try {
    bytes = await new Response(counted).arrayBuffer();
  } catch {
    throw new Problem('broke off while it was fetched');
  }
  return isGzip(bytes) ? unpack(bytes) : bytes;
}

/** The loader follows references of a file without a look at where they lead. */
function whatLoaderSays(error: Error): string {
  if (error instanceof TypeError) return `is damaged: something in it refers to what is not there (${error.message})`;
  return `cannot be read: ${error.message ?? error}`;
}

/** `folder`: where files are that a .gltf refers to. */
async function readBytes(bytes: ArrayBuffer, title: string, folder: string): Promise<Solution> {
  checkContainer(bytes, checkDocument);
  const loader = new GLTFLoader();
  loader.register((parser) => new DirectionalRadiancePlugin(parser, title));
  const gltf = await loader.parseAsync(bytes, folder);
  return gltf.userData.lobe as Solution;
}

/** Puts the file's title in front of what is wrong with it. */
async function titled<T>(title: string, work: () => Promise<T>): Promise<T> {
  try {
    return await work();
  } catch (error) {
    const why = error instanceof Problem ? error.message : whatLoaderSays(error as Error);
    throw new Problem(`${title}: ${why}`);
  }
}

/** Throws Problem, with the file's title in front. */
export function loadSolution(view: View, onProgress: (share?: number) => void): Promise<Solution> {
  return titled(view.title, async () => {
    const bytes = await fetchBytes(view.solution, onProgress);
    return readBytes(bytes, view.title, new URL('.', new URL(view.solution, location.href)).href);
  });
}

/** A file of whoever looks at the page; it is read here and sent nowhere. */
export function loadFile(file: File): Promise<Solution> {
  return titled(file.name, async () => {
    let bytes: ArrayBuffer;
    try {
      bytes = await file.arrayBuffer();
    } catch {
      throw new Problem('cannot be read from the disk');
    }
    // A .gltf alone has its .bin elsewhere, which a page may not look for.
    return readBytes(isGzip(bytes) ? await unpack(bytes) : bytes, file.name, '');
  });
}
