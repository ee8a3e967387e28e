import { findView, loadFile, loadSolution } from './solution/load';
import { Problem } from './solution/problem';
import type { Solution } from './solution/solution';
import { acceptFiles } from './ui/files';
import { Loading, hideProblem, showProblem } from './ui/notices';
import { offerHooks } from './ui/hooks';
import { Page } from './ui/page';
import { applyColours } from './ui/theme';

applyColours(document.documentElement.style);
let page: Page | null = null;
const loading = new Loading();
const files = acceptFiles((file) => {
  // What went wrong is on the page by now.
  open(file.name, () => loadFile(file)).catch(() => {});
});

type Progress = (title: string, share?: number) => void;

/** Whoever opens a file while another one comes wants the new one: only the latest is shown, or said to have failed. */
let latest: Promise<void>;
let opened = 0;

/** Ends as the latest does. */
function open(title: string, load: (progress: Progress) => Promise<Solution>): Promise<void> {
  const number = ++opened;
  return (latest = show(title, load, () => number === opened));
}

async function show(title: string, load: (progress: Progress) => Promise<Solution>, wanted: () => boolean): Promise<void> {
  hideProblem();
  loading.show(title);
  try {
    const solution = await load((...said) => wanted() && loading.show(...said));
    if (!wanted()) return latest;
    page?.dispose();
    page = null;
    page = new Page(solution, files.choose);
  } catch (error) {
    if (!wanted()) return latest;
    if (!(error instanceof Problem)) console.error(error);
    const sentence = error instanceof Problem ? error.message : `${title}: ${(error as Error).message ?? error}`;
    showProblem(sentence, files.choose, page !== null);
    throw new Problem(sentence);
  } finally {
    if (wanted()) loading.hide();
  }
}

const start = () => open('Lobe', async (progress) => {
  progress('Looking for the solution');
  const view = await findView(location.search);
  progress(view.title);
  return loadSolution(view, (share) => progress(view.title, share));
});

offerHooks(start(), () => page);
