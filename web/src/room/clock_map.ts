// SPDX-License-Identifier: Apache-2.0
// From a publisher's clock to ours, without either knowing the time of day: the smallest delay of the last 30 s stands
// for the way without a wait, what is above it is jitter.

const WINDOW = 30; // s
const JITTER_WINDOW = 64; // frames
/** A delay that is off by more: the publisher's clock has jumped, or the way is another one. */
export const JUMP = 5; // s
const LOW = 0.05; // s
const HIGH = 0.1; // s
const SLEW = 0.05; // s a second: how fast the play-out may be moved without being seen

/** Play-out delay for frames that come every `interval` s with this `jitter` (s): 50 to 100 ms. */
export function bufferFor(interval: number, jitter: number): number {
  return Math.min(HIGH, Math.max(LOW, interval + jitter));
}

/** Value below which `part` of the list is. */
function quantile(list: readonly number[], part: number): number | undefined {
  const sorted = [...list].sort((a, b) => a - b);
  return sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))];
}

export class ClockMap {
  private smallest: { at: number; delay: number }[] = []; // rising delays: the first is the least of the window
  private recent: { delay: number; interval: number }[] = [];
  private measured = { jitter: 0, interval: HIGH }; // s
  private lastCaptured: number | null = null;
  private lag: number | null = null; // now - the publisher's time that is played
  private lastAsked = 0;

  /** A frame came; both in s, each of its own clock. False when the clocks had to be set anew: older frames are void. */
  add(arrived: number, captured: number): boolean {
    const delay = arrived - captured;
    const offset = this.smallest[0]?.delay;
    const same = offset === undefined || Math.abs(delay - offset) <= JUMP;
    if (!same) this.reset();
    while (this.smallest.length && this.smallest.at(-1)!.delay >= delay) this.smallest.pop();
    this.smallest.push({ at: arrived, delay });
    while (this.smallest[0]!.at < arrived - WINDOW) this.smallest.shift();
    if (this.lastCaptured !== null) {
      this.recent.push({ delay, interval: captured - this.lastCaptured });
      if (this.recent.length > JITTER_WINDOW) this.recent.shift();
    }
    this.lastCaptured = captured;
    this.measure();
    return same;
  }

  /** Another clock. */
  reset(): void {
    this.smallest = [];
    this.recent = [];
    this.measured = { jitter: 0, interval: HIGH };
    this.lastCaptured = null;
    this.lag = null;
  }

  /** Least delay, s: of no meaning by itself, as the clocks have nothing in common. */
  get offset(): number | null {
    return this.smallest[0]?.delay ?? null;
  }

  /** 95 of 100 frames wait at most so long on their way, s. */
  get jitter(): number {
    return this.measured.jitter;
  }

  get buffer(): number {
    return bufferFor(this.measured.interval, this.measured.jitter);
  }

  private measure(): void {
    const offset = this.smallest[0]!.delay;
    const delays = this.recent.map((r) => r.delay - offset);
    const intervals = this.recent.map((r) => r.interval);
    this.measured = {
      jitter: Math.max(0, quantile(delays, 0.95) ?? 0),
      interval: quantile(intervals, 0.9) ?? HIGH, // the longer ones: frames get lost
    };
  }

  /** How late the play-out is, beyond the quickest way; s. */
  get delay(): number {
    return this.lag === null || this.offset === null ? this.buffer : this.lag - this.offset;
  }

  /** What of the publisher's time is played at `now`, s of its clock. It goes on steadily. */
  playout(now: number): number | null {
    const offset = this.offset;
    if (offset === null) return null;
    const wanted = offset + this.buffer;
    const step = SLEW * Math.max(0, now - this.lastAsked);
    this.lastAsked = now;
    if (this.lag === null || Math.abs(wanted - this.lag) > 0.5) this.lag = wanted;
    else this.lag += Math.min(step, Math.max(-step, wanted - this.lag));
    return now - this.lag;
  }
}
