/** Solutions of whoever looks at the page: dropped onto it, or chosen. */
import { region } from './dom';

export function acceptFiles(onFile: (file: File) => void): { choose(): void } {
  const input = region<HTMLInputElement>('file'), drop = region('drop');
  input.addEventListener('change', () => {
    const file = input.files?.[0];
    // So that the same file can be opened again.
    input.value = '';
    if (file) onFile(file);
  });
  const holdsFile = (event: DragEvent) => event.dataTransfer?.types.includes('Files') === true;
  window.addEventListener('dragover', (event) => {
    if (!holdsFile(event)) return;
    event.preventDefault();
    drop.hidden = false;
  });
  window.addEventListener('dragleave', (event) => {
    if (event.relatedTarget === null) drop.hidden = true;
  });
  window.addEventListener('drop', (event) => {
    if (!holdsFile(event)) return;
    event.preventDefault();
    drop.hidden = true;
    const file = event.dataTransfer?.files[0];
    if (file) onFile(file);
  });
  return { choose: () => input.click() };
}
