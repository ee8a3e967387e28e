/** Words about a lobe have the colour it is drawn in: the style sheet takes them from here. */
import { kLobeColours, kNegativeColour } from '../inspect/colours';

export function applyColours(to: CSSStyleDeclaration): void {
  to.setProperty('--first', kLobeColours[0]);
  to.setProperty('--second', kLobeColours[1]);
  to.setProperty('--negative', kNegativeColour);
}
