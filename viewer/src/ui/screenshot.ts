import type { Stage } from '../stage/stage';

/** The picture as it is shown, lobes and marks too, as PNG. */
export function screenshot(stage: Stage): Promise<Blob> {
  const { pixels, width, height } = stage.capture(stage.canvas.width, stage.canvas.height, { overlay: true });
  const source = document.createElement('canvas');
  source.width = width;
  source.height = height;
  source.getContext('2d')!.putImageData(new ImageData(new Uint8ClampedArray(pixels), width, height), 0, 0);
  return new Promise((resolve, reject) =>
    source.toBlob((blob) => (blob ? resolve(blob) : reject(new Error('the browser makes no PNG of it'))), 'image/png'));
}
