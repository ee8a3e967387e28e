/**
 * How far the viewer's picture is from one of `lobe render --mode stored`, or of another build of the viewer:
 *
 *     node bench/compare.mjs SOLUTION.glb CAMERA REFERENCE.png OUT.png ['settings as JSON']
 *
 * CAMERA is a number from 0. Differences are of 255, per channel, away from jumps of the reference and with them
 * (tests/viewer/support/pictures.mjs). OUT.png is the viewer's picture, as large as the reference.
 */
import path from 'node:path';
import { capture, closeBrowser } from '../../tests/viewer/support/page.mjs';
import { difference, nearJumps, readPng, writePng } from '../../tests/viewer/support/pictures.mjs';
import { withStage } from './stage.mjs';

const [file, camera, reference, out, settings = '{}'] = process.argv.slice(2);
const expected = readPng(reference);
await withStage(file, async (page) => {
  await page.evaluate(([camera, settings]) => {
    window.lobe.look(camera);
    window.lobe.stage.set(settings);
  }, [Number(camera), JSON.parse(settings)]);
  const shown = await capture(page, expected.width, expected.height);
  writePng(out, shown);
  const { byChannel, signed, share, far } = difference(expected, shown, nearJumps(expected));
  const words = (values) => values.map((v) => v.toFixed(3)).join(' ');
  console.log(`${path.basename(file)} ${camera}: mean ${words(byChannel)}, signed ${words(signed)} of 255 over ` +
    `${(100 * share).toFixed(1)} % of the pixels; ${(100 * far).toFixed(2)} % of them off by more than 16; ` +
    `mean over all ${words(difference(expected, shown).byChannel)}`);
}).finally(closeBrowser);
