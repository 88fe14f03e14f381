// SPDX-License-Identifier: Apache-2.0
// In each animation frame: the poses, then the picture.

import type { Roster } from "./roster";
import type { Rig } from "./rig";
import type { Cast } from "./scene/cast";
import type { MeetingStage } from "./scene/meeting_stage";
import type { Tags } from "./scene/tags";

export interface Shown {
  roster: Roster;
  me: string | null;
  /** The scene is covered. */
  covered: boolean;
}

export class MeetingLoop {
  ticks = 0;

  constructor(
    private readonly stage: MeetingStage,
    private readonly cast: Cast,
    private readonly rig: Rig,
    private readonly tags: Tags,
    private readonly what: () => Shown,
    private readonly calm: () => boolean,
  ) {}

  start(): void {
    const tick = (): void => {
      requestAnimationFrame(tick); // the browser calls nothing while the page is hidden
      this.ticks++;
      const now = performance.now() / 1000;
      if (this.stage.ready(now) || this.stage.blank) this.draw(now);
    };
    requestAnimationFrame(tick);
  }

  private draw(now: number): void {
    const { roster, me, covered } = this.what();
    this.tags.step(now);
    if (covered) {
      this.stage.paused();
      return;
    }
    const moved = this.cast.show(roster, now);
    const anchor = this.cast.anchor(me, roster);
    const eyes = this.rig.view === "eyes" && anchor ? me : null;
    this.cast.hide(eyes);
    this.stage.draw(now, moved, anchor, this.calm() || this.stage.software, eyes);
  }
}
