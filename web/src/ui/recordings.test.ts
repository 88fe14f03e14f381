// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it, vi } from "vitest";
import type { Status } from "../live/protocol";
import { Recordings } from "./recordings";
import { useFakePage } from "../shared/testing_dom";

const element = useFakePage();
let recordings: Recordings;
let sent: boolean[];
let said: string[];
let connected: boolean;

const status = (seconds: number | null, phase = "tracking"): void =>
  recordings.setStatus({
    phase,
    recording: seconds === null ? null : { seconds, frames: 1 },
    recordings: [],
  } as unknown as Status);
const label = (): string => element("record-label").textContent;

beforeEach(() => {
  sent = [];
  said = [];
  connected = true;
  recordings = new Recordings(
    (c) => {
      if (connected && c.type === "record") sent.push(c.on);
      return connected;
    },
    (words) => said.push(words),
  );
  status(null);
});

describe("recording", () => {
  it("starts and stops within a moment", () => {
    recordings.toggle();
    expect(label()).toBe("Starting…");
    expect(element("record").classes.has("on")).toBe(true);
    recordings.toggle();
    expect(label()).toBe("Stopping…");
    recordings.toggle();
    expect(sent).toEqual([true, false, true]);
  });

  it("is confirmed by a status that shows it", () => {
    recordings.toggle();
    status(null);
    expect(label()).toBe("Starting…");
    status(0.4);
    expect(label()).toBe("Stop 0:00");
    expect(said).toEqual(["Recording."]);
    recordings.toggle();
    status(0.9);
    expect(label()).toBe("Stopping…");
    expect(element("record").disabled).toBe(false);
    status(null);
    expect(label()).toBe("Record");
    recordings.toggle();
    expect(sent).toEqual([true, false, true]);
  });

  it("stops for as long as files are completed", () => {
    recordings.toggle();
    status(0.5);
    recordings.toggle();
    for (let i = 0; i < 20; i++) {
      vi.advanceTimersByTime(500);
      status(60);
      expect(label()).toBe("Stopping…");
    }
    status(null);
    expect(label()).toBe("Record");
    recordings.toggle();
    expect(sent).toEqual([true, false, true]);
  });

  it("that was stopped ignores an older status", () => {
    recordings.toggle();
    recordings.toggle();
    status(null);
    status(0.1); // of the first wish
    expect(label()).toBe("Stopping…");
    status(null);
    expect(label()).toBe("Record");
  });

  it("that does not start is forgotten", () => {
    recordings.toggle();
    vi.advanceTimersByTime(3100);
    status(null);
    expect(label()).toBe("Record");
    recordings.toggle();
    vi.advanceTimersByTime(3100); // without any status
    recordings.toggle();
    expect(sent).toEqual([true, true, true]);
  });

  it("can be stopped when the person has left", () => {
    recordings.toggle();
    status(null, "person");
    expect(element("record").disabled).toBe(false);
    recordings.toggle();
    expect(sent).toEqual([true, false]);
    expect(element("record").disabled).toBe(true);
  });

  it("is unknown without a connection", () => {
    recordings.toggle();
    recordings.disconnected();
    expect([label(), element("record").disabled]).toEqual(["Record", true]);
    status(null);
    expect(label()).toBe("Record");
    connected = false;
    recordings.toggle();
    expect(label()).toBe("Record");
    expect(said.join()).toMatch(/no connection/);
  });

  it("of a program that has died is over", () => {
    status(0.5);
    expect(label()).toBe("Stop 0:00");
    recordings.disconnected();
    expect(label()).toBe("Record");
    expect(element("record").classes.has("on")).toBe(false);
  });
});
