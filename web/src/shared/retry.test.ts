// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { Pause } from "./retry";

describe("a pause", () => {
  beforeEach(() => void vi.useFakeTimers());
  afterEach(() => void vi.useRealTimers());

  it("lasts as long as it is asked to, or until it is ended", async () => {
    const pause = new Pause();
    pause.end(); // nothing waits
    let over = 0;
    const wait = (ms: number) => void pause.wait(ms).then(() => over++);
    wait(1000);
    await vi.advanceTimersByTimeAsync(999);
    expect(over).toBe(0);
    await vi.advanceTimersByTimeAsync(1);
    expect(over).toBe(1);
    wait(1000);
    pause.end();
    await vi.advanceTimersByTimeAsync(0);
    expect(over).toBe(2);
  });
});
