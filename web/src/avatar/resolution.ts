// SPDX-License-Identifier: Apache-2.0
// How fine a view is drawn: as fine as the screen at first, coarser while the computer cannot keep up.

/** ms of a slow picture: more than the 33.3 ms of screens, browser sources and power savers with 30 pictures per second. */
const SLOW = 40;
const COUNT = 24; // pictures that are judged together, by their average
const LONG = 2000; // ms of pictures, which are enough too
const IDLE = 1000; // ms: more is not a slow picture, nothing had to be drawn
const STEPS = [2, 1.5, 1.25, 1, 0.75, 0.6, 0.5] as const;
/** A step down helps if pictures take less than this part of the time before: it leaves out 31 % of the pixels at least. */
const HELPS = 0.9;
/** ms before a step is tried that may be in vain. Each try doubles it, so that no computer flickers for ever. */
const WAIT = 10_000;

export class Resolution {
  private sum = 0;
  private count = 0;
  private level: number; // in STEPS
  private readonly finest: number;
  private before: number | null = null; // ms of a picture before the step down that was just made
  private fast = 0; // ms of fast pictures since the last step
  private upWait = WAIT;
  private downWait = WAIT;
  private pause = 0; // ms until the next step down may be made

  /** `device`: pixels of the screen for a pixel of the page. `software`: the browser draws without a graphics card. */
  constructor(
    public device: number,
    software: boolean,
  ) {
    this.level = this.finest = software ? STEPS.indexOf(1) : 0;
  }

  /** Pixels of the canvas for a pixel of the page. */
  get ratio(): number {
    return Math.min(this.device, STEPS[this.level]!);
  }

  /** Takes the time of a picture, ms; true when the ratio has changed. */
  drew(ms: number): boolean {
    if (ms > IDLE) return false;
    this.sum += ms;
    this.count++;
    if (this.count < COUNT && this.sum < LONG) return false;
    const { ratio } = this;
    this.judge(this.sum / this.count, this.sum);
    this.sum = this.count = 0;
    return this.ratio !== ratio;
  }

  /** `ms`: of a picture; `all`: of the pictures since the last judgement. */
  private judge(ms: number, all: number): void {
    const slow = ms > SLOW;
    const inVain = slow && this.before !== null && ms > HELPS * this.before;
    this.before = null;
    this.fast = slow ? 0 : this.fast + all;
    this.pause -= all;
    if (inVain) {
      this.level--;
      this.pause = this.downWait;
      this.downWait *= 2;
    } else if (slow && this.pause <= 0) {
      this.goDown(ms);
    } else if (this.fast >= this.upWait) {
      this.goUp();
    }
  }

  private goDown(ms: number): void {
    const next = STEPS.findIndex((s) => s < this.ratio - 1e-6);
    if (next < 0) return;
    this.level = next;
    this.before = ms;
  }

  private goUp(): void {
    this.fast = 0;
    if (this.level > this.finest && STEPS[this.level]! < this.device) {
      this.level--;
      this.upWait *= 2;
    } else {
      this.upWait = this.downWait = WAIT;
    }
  }
}
