// SPDX-License-Identifier: Apache-2.0
// Maps a publisher's clock to the local one, without a common time of day: the smallest delay of the last 30 s counts as the
// transmission time, and what exceeds it as jitter.

const WINDOW = 30; // s
const JITTER_WINDOW = 64; // frames
/** A delay that differs by more means that the publisher's clock has jumped. */
export const JUMP = 5; // s
const LOW = 0.05; // s
const HIGH = 0.1; // s
const SLEW = 0.05; // s per second: how fast the playout may shift without being visible

/** Playout delay for frames every `interval` s with this `jitter` (s): 50 to 100 ms. */
export function bufferFor(interval: number, jitter: number): number {
  return Math.min(HIGH, Math.max(LOW, interval + jitter));
}

/** The value that `part` of the list is below. */
function quantile(list: readonly number[], part: number): number | undefined {
  const sorted = [...list].sort((a, b) => a - b);
  return sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))];
}

export class ClockMap {
  private smallest: { at: number; delay: number }[] = []; // rising delays: the first is the smallest of the window
  private recent: { delay: number; interval: number }[] = [];
  private measured = { jitter: 0, interval: HIGH }; // s
  private lastCaptured: number | null = null;
  private lag: number | null = null; // now - the publisher's time that is played
  private lastAsked = 0;

  /** Takes the times of a frame, s of their own clocks. False when the map has been reset: older frames are invalid. */
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

  /** Forgets everything: the publisher has another clock. */
  reset(): void {
    this.smallest = [];
    this.recent = [];
    this.measured = { jitter: 0, interval: HIGH };
    this.lastCaptured = null;
    this.lag = null;
  }

  /** Smallest delay, s. It has no meaning by itself, as the clocks are independent. */
  get offset(): number | null {
    return this.smallest[0]?.delay ?? null;
  }

  /** 95th percentile of the delay beyond the smallest one, s. */
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
      interval: quantile(intervals, 0.9) ?? HIGH, // a long one: frames get lost
    };
  }

  /** Delay of the playout beyond the transmission time, s. */
  get delay(): number {
    return this.lag === null || this.offset === null ? this.buffer : this.lag - this.offset;
  }

  /** The publisher's time to play at `now`, s of its clock. It advances steadily. */
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
