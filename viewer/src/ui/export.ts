/** Files that the inspector hands out. */
import { toJson } from '../inspect/inspection';
import type { Selection } from '../inspect/selection';
import type { Solution } from '../solution/solution';
import { download } from './dom';
import { stem } from './format';
import { slicesDrawing } from './plots';

function nameOf(solution: Solution, selection: Selection, ending: string): string {
  const { node, compared } = selection;
  return `${stem(solution.title)}_node${node}${compared === null ? '' : `_${compared}`}.${ending}`;
}

/** One lobe as `lobe inspect --json` writes it; of two, a list. */
export function saveJson(solution: Solution, selection: Selection): void {
  const said = ([0, 1] as const).flatMap((seat) => selection.of(seat) ?? []).map(toJson);
  const text = JSON.stringify(said.length === 1 ? said[0] : said, null, 2);
  download(nameOf(solution, selection, 'json'), new Blob([`${text}\n`], { type: 'application/json' }));
}

export function saveSvg(solution: Solution, selection: Selection): void {
  download(nameOf(solution, selection, 'svg'), new Blob([slicesDrawing(selection)], { type: 'image/svg+xml' }));
}
