// SPDX-License-Identifier: Apache-2.0
// When a lost connection is tried again.

export type ConnectionState =
  | { kind: "connecting" }
  | { kind: "open" } // and the other side has sent something
  /** `retryAt`: time of the next try by performance.now(); `words`: the reason, or empty. */
  | { kind: "lost"; retryAt: number; words: string };

/** Delay before try number `n` (from 0), ms: 0.5 s, doubled up to 10 s. `chance` in [0, 1) spreads many pages. */
export function retryDelay(n: number, chance: number): number {
  return Math.min(10000, 500 * 2 ** n) * (0.8 + 0.4 * chance);
}

/** A pause that can be ended before its time. */
export class Pause {
  private over: () => void = () => undefined;

  wait(ms: number): Promise<void> {
    return new Promise((done) => {
      const timer = setTimeout(done, ms);
      this.over = () => {
        clearTimeout(timer);
        done();
      };
    });
  }

  end(): void {
    this.over();
  }
}
