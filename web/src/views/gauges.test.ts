// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it, vi } from "vitest";
import type { Phase, Status } from "../live/protocol";
import { useFakePage } from "../shared/testing_dom";
import { Gauges } from "./gauges";

const lines = vi.hoisted(() => ({ cleared: 0 }));
vi.mock("./sparkline", () => ({
  Sparkline: class {
    push(): void {}
    draw(): void {}
    clear(): void {
      lines.cleared++;
    }
  },
}));

const IDS = ["tracked", "input", "dropped", "median", "p95", "total", "f", "dc", "cpu"];
const element = useFakePage();
let gauges: Gauges;
const shown = () => Object.fromEntries(IDS.map((id) => [id, element(`gauge-${id}`).textContent]));

const status = (phase: Phase): void =>
  gauges.setStatus({
    phase,
    fps: { input: 25, tracked: 24.6 },
    dropped: 3,
    ms: new Map([
      ["search", 22],
      ["total", 33],
    ]),
    latency: { median: 61, p95: 84 },
    cpu: 1.1,
  } as unknown as Status);

beforeEach(() => {
  lines.cleared = 0;
  gauges = new Gauges();
});

describe("gauges", () => {
  it("show a latency only while tracking", () => {
    status("tracking");
    expect(shown()).toMatchObject({ tracked: "24.6", median: "61", p95: "84" });
    for (const phase of ["lost", "person", "stopped", "ended", "empty_room"] as const) {
      status("tracking");
      status(phase);
      expect([phase, shown().median, shown().p95]).toEqual([phase, "–", "–"]);
    }
  });

  it("show the networks apart from the other features", () => {
    const legend = (ms: [string, number][]): string => {
      gauges.setStatus({
        phase: "tracking",
        fps: { input: 25, tracked: 25 },
        ms: new Map(ms),
      } as unknown as Status);
      return element("stage-legend").textContent;
    };
    expect(
      legend([
        ["networks", 12],
        ["features", 20],
        ["total", 33],
      ]),
    ).toBe("networks 12features 8.0");
    expect(
      legend([
        ["networks", 0],
        ["features", 20],
        ["total", 33],
      ]),
    ).toBe("features 20");
  });

  it("are cleared when disconnected", () => {
    status("tracking");
    gauges.setPose({
      type: "pose",
      state: "tracking",
      F: 0.1,
      Dc: 1.8,
    } as unknown as Parameters<Gauges["setPose"]>[0]);
    expect(Object.values(shown())).not.toContain("–");
    gauges.disconnected();
    for (const [id, words] of Object.entries(shown())) expect([id, words]).toEqual([id, "–"]);
    expect(element("stage-legend").textContent).toBe("");
    expect(lines.cleared).toBe(4);
    status("tracking");
    expect(shown()).toMatchObject({ tracked: "24.6", cpu: "1.10", total: "33" });
  });
});
