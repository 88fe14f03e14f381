// SPDX-License-Identifier: Apache-2.0
// Once for each picture of the screen: avatar first, then the flat views; then `drawn` for the program.

import type { PoseDriver } from "../avatar/driver";
import type { Avatar } from "../avatar/load";
import type { Stage } from "../avatar/stage";
import type { Command } from "../protocol";
import { byId } from "../ui/dom";
import type { CameraView } from "../views/camera";
import type { TopView } from "../views/top";

export class Loop {
  private stage: Stage | null = null;
  private rest = 1;
  private lastShown = -1;
  private ticks = 0;
  private drawnSent = 0;
  private readonly after = new MessageChannel();
  private drawn: { frame: number; stamp: number } | null = null;

  constructor(
    private readonly driver: PoseDriver,
    private readonly camera: CameraView,
    private readonly top: TopView,
    send: (c: Command) => boolean,
    private readonly complain: (words: string) => void,
  ) {
    // A task of its own, after the picture has been handed over.
    this.after.port1.onmessage = () => {
      this.stage?.settle();
      const d = this.drawn;
      this.drawn = null;
      if (d && send({ type: "drawn", ...d })) this.drawnSent++;
    };
    void this.openStage();
  }

  private async openStage(): Promise<Stage | null> {
    if (this.stage) return this.stage;
    const loaded = await import("../avatar/stage").catch(() => null);
    if (this.stage) return this.stage;
    if (!loaded) {
      this.complain("The part of this page that draws the avatar did not load: load the page again.");
      return null;
    }
    try {
      const [canvas, view] = [byId("avatar-canvas", HTMLCanvasElement), byId("avatar-view", HTMLElement)];
      this.stage = new loaded.Stage(canvas, view);
      this.driver.direct = this.stage.software;
    } catch {
      this.complain(
        "This browser cannot draw in 3-D (WebGL is off): the avatar is not shown. All else works.",
      );
    }
    return this.stage;
  }

  get avatar(): Avatar | null {
    return this.stage?.current ?? null;
  }

  /** Numbers for tests and for the curious. `shown`: the frame of the newest pose that was drawn. */
  get counters(): Record<string, number> {
    return {
      ticks: this.ticks,
      renders: this.stage?.pictures ?? 0,
      ratio: this.stage?.ratio ?? 0,
      drawnSent: this.drawnSent,
      shown: this.lastShown,
      rest: this.rest,
    };
  }

  setAvatar(a: Avatar): void {
    void this.openStage().then((s) => s?.setAvatar(a));
  }

  resetView(): void {
    this.stage?.resetView();
  }

  start(): void {
    const tick = (): void => {
      requestAnimationFrame(tick); // the browser calls nothing while the page is hidden
      this.ticks++;
      this.showAvatar();
      this.camera.draw();
      this.top.draw();
    };
    requestAnimationFrame(tick);
  }

  private showAvatar(): void {
    const now = performance.now() / 1000;
    const shown = this.driver.step(now);
    this.rest = shown.rest;
    const rendered = this.stage?.draw(shown, now) ?? false;
    if (!rendered || !shown.fresh) return;
    this.lastShown = shown.fresh.frame;
    this.drawn = { frame: shown.fresh.frame, stamp: shown.fresh.stamp };
    this.after.port2.postMessage(null);
  }
}
