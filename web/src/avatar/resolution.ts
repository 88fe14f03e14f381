// SPDX-License-Identifier: Apache-2.0
// How fine the avatar is drawn: as fine as the screen at first, coarser when the computer cannot keep up.

const SLOW = 30; // ms between pictures
const MANY = 24; // pictures in a row, on average slow
const LONG = 2000; // ms of slow pictures are enough, too
const STEPS = [2, 1.5, 1.25, 1, 0.75, 0.6] as const;

export class Resolution {
  private sum = 0;
  private count = 0;
  private ceiling: number;

  /** `software`: the browser draws without a graphics card. */
  constructor(
    private readonly device: number,
    software: boolean,
  ) {
    this.ceiling = software ? 1 : 2;
  }

  /** Pixels of the canvas for a pixel of the page. */
  get ratio(): number {
    return Math.min(this.device, this.ceiling);
  }

  /** Told the time since the last drawn picture, ms; true when the ratio went down. */
  drew(ms: number): boolean {
    if (ms > 1000) return false; // a pause, not a slow computer
    this.sum += ms;
    this.count++;
    if (this.count < MANY && this.sum < LONG) return false;
    const slow = this.sum / this.count > SLOW;
    this.sum = this.count = 0;
    const next = STEPS.find((s) => s < this.ratio - 1e-6);
    if (!slow || next === undefined) return false;
    this.ceiling = next;
    return true;
  }
}
