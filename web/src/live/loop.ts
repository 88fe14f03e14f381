// SPDX-License-Identifier: Apache-2.0
// In each animation frame: the avatar first, then the flat views. Each pose that was drawn is reported to the program.

import type { PoseDriver } from "../avatar/driver";
import type { Avatar } from "../avatar/load";
import type { Stage, StageOptions } from "../avatar/stage";
import { byId } from "../shared/dom";
import { NoWebGl } from "../shared/graphics";
import type { Command } from "./protocol";

interface Stamped {
  frame: number;
  stamp: number;
}

export class Loop {
  private stage: Stage | null = null;
  private rest = 1;
  private lastShown = -1;
  private ticks = 0;
  private drawnSent = 0;
  private readonly after = new MessageChannel();
  private fresh: Stamped | null = null; // the newest pose that is not drawn yet
  private drawn: Stamped | null = null; // drawn and not reported yet

  /** `flat`: the views beside the avatar; `complain` shows an error to the user. */
  constructor(
    private readonly driver: PoseDriver,
    private readonly flat: readonly { draw(): void }[],
    private readonly send: (c: Command) => boolean,
    private readonly complain: (words: string) => void,
    private readonly options: StageOptions = {},
  ) {
    // A separate task: it runs after the picture has been handed over.
    this.after.port1.onmessage = () => this.report();
    void this.openStage();
  }

  private async openStage(): Promise<Stage | null> {
    if (this.stage) return this.stage;
    const loaded = await import("../avatar/stage").catch(() => null);
    if (this.stage) return this.stage;
    if (!loaded) {
      this.complain("The 3-D part of this page could not be loaded. Reload the page.");
      return null;
    }
    try {
      const [canvas, view] = [byId("avatar-canvas", HTMLCanvasElement), byId("avatar-view", HTMLElement)];
      this.stage = new loaded.Stage(canvas, view, this.options);
      this.driver.direct = this.stage.painter.software;
    } catch (e) {
      const others = this.options.alone ? "" : " Everything else works.";
      const why = e instanceof NoWebGl ? "WebGL is off in this browser." : `${String(e)}. Reload the page.`;
      this.complain(`The avatar cannot be shown: ${why}${others}`);
    }
    return this.stage;
  }

  get avatar(): Avatar | null {
    return this.stage?.avatar ?? null;
  }

  /** For tests; see Debug.counters. */
  get counters(): Record<string, number> {
    return {
      ticks: this.ticks,
      renders: this.stage?.painter.pictures ?? 0,
      ratio: this.stage?.painter.ratio ?? 0,
      drawnSent: this.drawnSent,
      shown: this.lastShown,
      rest: this.rest,
    };
  }

  /** False, with a complaint, when there is nothing to show the avatar on. */
  async setAvatar(a: Avatar): Promise<boolean> {
    const stage = await this.openStage();
    stage?.setAvatar(a);
    return stage !== null;
  }

  resetView(): void {
    this.stage?.resetView();
  }

  start(): void {
    const tick = (): void => {
      requestAnimationFrame(tick); // the browser calls nothing while the page is hidden
      this.ticks++;
      this.showAvatar();
      for (const view of this.flat) view.draw();
    };
    requestAnimationFrame(tick);
  }

  private showAvatar(): void {
    this.report();
    const now = performance.now() / 1000;
    const shown = this.driver.step(now);
    this.fresh = shown.fresh ?? this.fresh;
    if (!this.stage?.draw(shown, now)) return;
    this.rest = shown.rest;
    if (!this.fresh) return;
    this.lastShown = this.fresh.frame;
    this.drawn = { frame: this.fresh.frame, stamp: this.fresh.stamp };
    this.fresh = null;
    this.after.port2.postMessage(null);
  }

  /** Reports the last pose once its picture is complete. */
  private report(): void {
    if (!this.drawn || this.stage?.painter.busy) return;
    if (this.send({ type: "drawn", ...this.drawn })) this.drawnSent++;
    this.drawn = null;
  }
}
