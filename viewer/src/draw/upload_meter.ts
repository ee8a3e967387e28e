/** Counts the bytes that a context is sent as textures and buffers, by listening to the calls that send them. */
export function meterUploads(gl: WebGL2RenderingContext, count: (bytes: number) => void): void {
  const size = (argument: unknown): number =>
    ArrayBuffer.isView(argument) || argument instanceof ArrayBuffer ? argument.byteLength : 0;
  for (const name of ['bufferData', 'bufferSubData', 'texImage2D', 'texSubImage2D', 'texImage3D', 'texSubImage3D'] as const) {
    const call = gl[name].bind(gl) as (...all: unknown[]) => void;
    (gl as unknown as Record<string, unknown>)[name] = (...all: unknown[]) => {
      for (const argument of all) count(size(argument));
      call(...all);
    };
  }
}
