// SPDX-License-Identifier: Apache-2.0
// Measurements: rate, latency, times of the stages, residuals, processor time.

import type { Phase, Pose, Status } from "../live/protocol";
import { byId, h, setText } from "../shared/dom";
import { Sparkline } from "./sparkline";

const HISTORY = 120; // poses
const STAGE_COLOURS = ["#0f9b88", "#d8637a", "#5d8fe8", "#d39b2a", "#b36fc4"];
const DRAW_INTERVAL = 250; // ms between drawings of the history

/** Phases with measurements of the tracker. */
const MEASURED: readonly Phase[] = ["person", "tracking", "lost", "ended"];

/** Ids of gauges that are plain numbers. */
const VALUES = ["tracked", "input", "dropped", "median", "p95", "f", "dc"].map((name) => `gauge-${name}`);

export const show = (v: number | null | undefined, digits = 0): string =>
  v === null || v === undefined ? "–" : v.toFixed(digits);

export class Gauges {
  private readonly F = new Sparkline(byId("spark-f", HTMLCanvasElement), HISTORY, 0.05);
  private readonly Dc = new Sparkline(byId("spark-dc", HTMLCanvasElement), HISTORY, 0.5);
  private readonly rate = new Sparkline(byId("spark-rate", HTMLCanvasElement), 60, 4);
  private readonly latency = new Sparkline(byId("spark-latency", HTMLCanvasElement), 60, 20);
  private drawn = -Infinity;

  setPose(pose: Pose): void {
    const t = pose.state === "tracking" ? pose : null;
    this.F.push(t?.F ?? null);
    this.Dc.push(t?.Dc ?? null);
    const now = performance.now();
    if (now - this.drawn < DRAW_INTERVAL) return;
    this.drawn = now;
    this.F.draw();
    this.Dc.draw();
    this.put("gauge-f", show(t?.F, 3));
    this.put("gauge-dc", show(t?.Dc, 2));
  }

  setStatus(s: Status): void {
    // The status keeps the last reported latency when the pages report no more.
    const latency = s.phase === "tracking" ? s.latency : null;
    this.rate.push(s.fps.tracked);
    this.latency.push(latency?.median ?? null);
    this.rate.draw();
    this.latency.draw();
    const tracks = MEASURED.includes(s.phase);
    this.put("gauge-tracked", tracks ? show(s.fps.tracked, 1) : "–");
    this.put("gauge-input", tracks ? show(s.fps.input) : "–");
    if (s.phase !== "tracking") for (const id of ["gauge-f", "gauge-dc"]) this.put(id, "–");
    this.put("gauge-dropped", show(s.dropped));
    this.put("gauge-median", show(latency?.median));
    this.put("gauge-p95", show(latency?.p95));
    this.processor(s.cpu);
    this.stages(tracks ? s.ms : new Map());
  }

  /** Clears what was measured before the connection was lost. */
  disconnected(): void {
    for (const line of [this.F, this.Dc, this.rate, this.latency]) {
      line.clear();
      line.draw();
    }
    for (const id of VALUES) this.put(id, "–");
    this.processor(null);
    this.stages(new Map());
  }

  private processor(cores: number | null): void {
    this.put("gauge-cpu", show(cores, 2));
    const bar = byId("cpu-bar", HTMLElement);
    bar.style.setProperty("--part", String(Math.min(1, (cores ?? 0) / 2)));
  }

  private stages(ms: Map<string, number>): void {
    // Networks are a part of the features.
    const networks = ms.get("networks") ?? 0;
    const parts = [...ms]
      .filter(([name, v]) => name !== "total" && (name !== "networks" || v > 0))
      .map(([name, v]): [string, number] => [name, name === "features" ? Math.max(0, v - networks) : v]);
    const total = ms.get("total") ?? parts.reduce((sum, [, v]) => sum + v, 0);
    this.put("gauge-total", parts.length || ms.has("total") ? show(total) : "–");
    const whole = Math.max(
      total,
      parts.reduce((sum, [, v]) => sum + v, 0),
      1e-9,
    );
    byId("stage-bar", HTMLElement).replaceChildren(
      ...parts.map(([name, v], i) => {
        const part = h("span", { title: `${name} ${show(v, 1)} ms` });
        part.style.width = `${(100 * v) / whole}%`;
        part.style.background = STAGE_COLOURS[i % STAGE_COLOURS.length]!;
        return part;
      }),
    );
    byId("stage-legend", HTMLElement).replaceChildren(
      ...parts.map(([name, v], i) => {
        const mark = h("i");
        mark.style.background = STAGE_COLOURS[i % STAGE_COLOURS.length]!;
        return h("span", { class: "stage-key" }, mark, `${name} `, h("b", {}, show(v, v < 10 ? 1 : 0)));
      }),
    );
  }

  private put(id: string, text: string): void {
    setText(byId(id, HTMLElement), text);
  }
}
