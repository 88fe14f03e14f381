// SPDX-License-Identifier: Apache-2.0

/** Allows `most` at once and `perSecond` in the long run. Times in s. */
export class RateLimit {
  private left: number;
  private at = -Infinity;

  constructor(
    private readonly most: number,
    private readonly perSecond: number,
  ) {
    this.left = most;
  }

  /** Whether one more is allowed; it then counts. */
  take(now: number): boolean {
    this.left = Math.min(this.most, this.left + (now - this.at) * this.perSecond);
    this.at = now;
    if (this.left < 1) return false;
    this.left--;
    return true;
  }
}
