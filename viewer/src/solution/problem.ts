/** What is wrong with a file, in one sentence that a person can act on. The page shows it as it is. */
export class Problem extends Error {
  override name = 'Problem';
}
