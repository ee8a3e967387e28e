import { vi } from 'vitest';
import { loadSolution } from '../../src/solution/load';
import type { Solution } from '../../src/solution/solution';

/** Opens a file's bytes as the page does, from a server that answers with `response`. */
export async function openResponse(response: () => Response, onProgress: (share?: number) => void = () => {}): Promise<Solution> {
  vi.stubGlobal('location', { href: 'http://viewer.test/index.html' });
  vi.stubGlobal('fetch', async () => response());
  try {
    return await loadSolution({ solution: 'room.glb', title: 'room.glb' }, onProgress);
  } finally {
    vi.unstubAllGlobals();
  }
}

export const open = (bytes: ArrayBuffer): Promise<Solution> => openResponse(() => new Response(bytes));

/** What the page says of a file it cannot show. */
export async function problemOf(bytes: ArrayBuffer): Promise<string> {
  try {
    await open(bytes);
  } catch (error) {
    if ((error as Error).name === 'Problem') return (error as Error).message;
    throw error;
  }
  return 'none';
}
