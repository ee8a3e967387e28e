/** The keys of the page, and what mouse and fingers do: what the help shows. */
import type { Key, KeyGroup } from '../stage/keys';

export interface KeyActions {
  camera(index: number): void;
  reset(): void;
  focus(): void;
  all(): void;
  toggleMode(): void;
  pickMiddle(shift: boolean): void;
  pin(): void;
  escape(): void;
  exposure(stops: number): void;
  degree(by: number): void;
  wireframe(): void;
  backs(): void;
  panel(): void;
  open(): void;
  help(): void;
}

/** Stops of a key's press. */
const kStops = 0.25;

export function keyGroups(does: KeyActions): KeyGroup[] {
  const letter = (k: string) => [k.toLowerCase(), k.toUpperCase()];
  const key = (shown: string, what: string, keys: readonly string[], run: Key['run'], onCanvas = false): Key =>
    ({ keys, shown, does: what, run, onCanvas });
  const said = (shown: string, what: string): Key => ({ keys: [], shown, does: what });
  return [
    {
      title: 'Look',
      keys: [
        said('drag', 'Turn about the target; in walk mode turn the head'),
        said('Shift + drag', 'Shift the view, as the right button does'),
        said('wheel', 'Nearer to what is under the cursor; in walk mode change the speed'),
        said('fingers', 'One turns; two shift and pinch'),
        said('← ↑ ↓ →', 'Turn; with Shift, shift'),
        said('+ / -', 'Nearer, farther'),
        key('1 / … / 9', 'Named cameras', [...'123456789'], (event) => does.camera(Number(event.key) - 1)),
        key('R', 'Back to the first camera', letter('r'), does.reset),
        key('F', 'Go to the selected node, or see all', letter('f'), does.focus),
        key('Home', 'See all', ['Home'], does.all, true),
      ],
    },
    {
      title: 'Walk',
      keys: [
        key('V', 'Walk, or turn about again', letter('v'), does.toggleMode),
        said('W A S D', 'Ahead, left, back, right'),
        said('Q / E', 'Down, up'),
        said('Shift', 'Four times as fast'),
      ],
    },
    {
      title: 'Lobes',
      keys: [
        said('click', 'The lobe of a node'),
        said('Shift + click', 'Compare with another'),
        key('Enter', 'The node in the middle, while the scene has the focus; with Shift, to compare', ['Enter'], (event) => does.pickMiddle(event.shiftKey), true),
        key('C', 'Keep the node, the next one is compared', letter('c'), does.pin),
        key(', / .', 'Degree down, up', [','], () => does.degree(-1)),
        // Said in the line above.
        key('', '', ['.'], () => does.degree(1)),
        key('Esc', 'Leave the node', ['Escape'], does.escape),
      ],
    },
    {
      title: 'Picture',
      keys: [
        // While walking E goes up, and Controls has taken it before it gets here.
        key('E / ]', 'A quarter of a stop brighter', ['e', ']'], () => does.exposure(kStops)),
        key('[ / Shift + E', 'A quarter of a stop darker', ['E', '['], () => does.exposure(-kStops)),
        key('X', 'Edges of the elements', letter('x'), does.wireframe),
        key('B', 'See through the backs of walls', letter('b'), does.backs),
        key('P', 'Show or hide the panel', letter('p'), does.panel),
        key('O', 'Open a solution', letter('o'), does.open),
        key('?', 'This list', ['?'], does.help),
      ],
    },
  ];
}
