import { findView, loadFile, loadSolution } from './solution/load';
import { Problem } from './solution/problem';
import type { Solution } from './solution/solution';
import { acceptFiles } from './ui/files';
import { Loading, hideProblem, showProblem } from './ui/notices';
import { offerHooks } from './ui/hooks';
import { Page } from './ui/page';

let page: Page | null = null;
const loading = new Loading();
const files = acceptFiles((file) => {
  // What went wrong is on the page by now.
  open(file.name, () => loadFile(file)).catch(() => {});
});

async function open(title: string, load: () => Promise<Solution>): Promise<void> {
  hideProblem();
  loading.show(title);
  try {
    const solution = await load();
    page?.dispose();
    page = null;
    page = new Page(solution, files.choose);
  } catch (error) {
    if (!(error instanceof Problem)) console.error(error);
    const sentence = error instanceof Problem ? error.message : `${title}: ${(error as Error).message ?? error}`;
    showProblem(sentence, files.choose, page !== null);
    throw new Problem(sentence);
  } finally {
    loading.hide();
  }
}

async function start(): Promise<void> {
  loading.show('Looking for the solution');
  let title = 'Lobe';
  await open(title, async () => {
    const view = await findView(location.search);
    title = view.title;
    document.title = title;
    return loadSolution(view, (share) => loading.show(title, share));
  });
}

offerHooks(start(), () => page);
