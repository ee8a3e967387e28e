// Debian's Chromium, without a screen or a graphics card, and pages in it that notice whatever goes wrong.
import assert from 'node:assert/strict';
import { execSync } from 'node:child_process';
import { chromium } from './packages.mjs';

const kViewport = { width: 960, height: 640 };
/** For what is not about the picture: frames in software take long. */
export const kSmall = { width: 480, height: 400 };
/** On a busy machine a frame takes a second in software. */
const kPatienceMs = 60000;

let browser = null;

async function launch() {
  let executablePath;
  try {
    executablePath = execSync('command -v chromium', { encoding: 'utf8' }).trim();
  } catch {
    throw new Error('there is no chromium; `bash cmake/install-dependencies.sh browser` installs it');
  }
  // Containers often have little shared memory.
  const args = ['--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-dev-shm-usage'];
  if (process.getuid() === 0) args.push('--no-sandbox');
  return chromium.launch({ executablePath, args });
}

/** At the end of all. */
export const closeBrowser = () => browser?.close();

/**
 * Opens an address in a fresh profile, `viewport` large, and calls `look` with the page and with what was noticed: `errors` of console
 * and scripts, `foreign` requests to elsewhere.
 */
export async function withPage(address, look, viewport = kViewport) {
  browser ??= await launch();
  const context = await browser.newContext({ viewport });
  try {
    const page = await context.newPage();
    page.setDefaultTimeout(kPatienceMs);
    const noticed = { errors: [], foreign: [] };
    page.on('console', (message) => message.type() === 'error' && noticed.errors.push(message.text()));
    page.on('pageerror', (error) => noticed.errors.push(`uncaught: ${error.message}`));
    page.on('request', (request) => {
      const url = new URL(request.url());
      if (!['data:', 'blob:'].includes(url.protocol) && url.origin !== new URL(address).origin) noticed.foreign.push(url.href);
    });
    await page.goto(address);
    return await look(page, noticed);
  } finally {
    await context.close();
  }
}

/** Waits for the scene to stand; throws what the page says if it does not come to that. */
export async function ready(page, noticed) {
  const said = () => page.evaluate(() => document.querySelector('#problem')?.textContent || document.body.innerText);
  try {
    await page.waitForFunction(() => window.lobe || document.querySelector('#problem')?.innerText);
  } catch {
    throw new Error(`the page has no window.lobe; it says "${await said()}", and ${noticed.errors.join('; ')}`);
  }
  if (!(await page.evaluate(() => !!window.lobe))) throw new Error(`the page says "${await said()}"`);
  await page.evaluate(async () => {
    await window.lobe.ready;
  });
}

/** As withPage, of a page that shows a scene, once it does; whatever is done with it must go without an error. */
export const withScene = (address, look, viewport) => withPage(address, async (page, noticed) => {
  await ready(page, noticed);
  const seen = await look(page, noticed);
  assert.deepEqual(noticed.errors, []);
  return seen;
}, viewport);

/** The scene from where the eye is, as {width, height, data}: RGBA, the top row first. */
export async function capture(page, width, height) {
  const base64 = await page.evaluate(async ([w, h]) => {
    const { pixels } = await window.lobe.stage.capture(w, h);
    let text = '';
    for (let i = 0; i < pixels.length; i += 4096) text += String.fromCharCode(...pixels.subarray(i, i + 4096));
    return btoa(text);
  }, [width, height]);
  return { width, height, data: Buffer.from(base64, 'base64') };
}

/** Lets the page draw what was asked for. */
export const frame = (page) =>
  page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
