/** What of a solution's record says how far it can be trusted (format.md#document). */
export interface TrustRecord {
  stopReason?: string;
  ledger?: { imbalance?: number[]; delivered?: number[] };
}

const kMostImbalance = 0.1;  // solver/trust.h

/** Why its light is not to be trusted, or not all there, in a few words; empty if it is. As solver/trust.h says it. */
export function trustOf(record: TrustRecord): string {
  const sum = (values: number[] | undefined) => (values ?? []).reduce((all, v) => all + Math.abs(v), 0);
  const delivered = sum(record.ledger?.delivered);
  const imbalance = delivered > 0 ? sum(record.ledger?.imbalance) / delivered : 0;
  const percent = `imbalance ${(100 * imbalance).toPrecision(2)} %`;
  if (record.stopReason === 'not converging') return `did not converge, not to be trusted (${percent})`;
  if (imbalance > kMostImbalance) return `mesh too coarse, not to be trusted (${percent})`;
  if (record.stopReason !== undefined && record.stopReason !== 'converged') {
    return `not finished (${record.stopReason})`;
  }
  return '';
}
