// SPDX-License-Identifier: Apache-2.0
// How fine a view is drawn: as fine as the screen at first, coarser when the computer cannot keep up.

const SLOW = 30; // ms between pictures
const SLOW_SOFTWARE = 60; // ms, without a graphics card
const COUNT = 24; // pictures in a row that are slow on average
const LONG = 2000; // ms of slow pictures, which are enough too
const STEPS = [2, 1.5, 1.25, 1, 0.75, 0.6, 0.5] as const;

export class Resolution {
  private sum = 0;
  private count = 0;
  private ceiling: number;
  private readonly slow: number;

  /** `device`: pixels of the screen for a pixel of the page. `software`: the browser draws without a graphics card. */
  constructor(
    private readonly device: number,
    software: boolean,
  ) {
    this.ceiling = software ? 1 : 2;
    this.slow = software ? SLOW_SOFTWARE : SLOW;
  }

  /** Pixels of the canvas for a pixel of the page. */
  get ratio(): number {
    return Math.min(this.device, this.ceiling);
  }

  /** Takes the time since the last picture, ms; true when the ratio has gone down. */
  drew(ms: number): boolean {
    if (ms > 1000) return false; // a pause, not a slow computer
    this.sum += ms;
    this.count++;
    if (this.count < COUNT && this.sum < LONG) return false;
    const slow = this.sum / this.count > this.slow;
    this.sum = this.count = 0;
    const next = STEPS.find((s) => s < this.ratio - 1e-6);
    if (!slow || next === undefined) return false;
    this.ceiling = next;
    return true;
  }
}
