// SPDX-License-Identifier: Apache-2.0
// Once for each picture of the screen: poses, then the picture. Without a graphics card pictures leave time for the rest
// of the page.

import type { Roster } from "./roster";
import type { Rig } from "./rig";
import type { Cast } from "./scene/cast";
import type { RoomStage } from "./scene/room_stage";
import type { Tags } from "./scene/tags";

/** Without a graphics card: part of a picture's own time that passes before the next is begun. */
const BREATHER = 0.5;
const SLOW = 1 / 20; // s between pictures at least, there

export interface Shown {
  roster: Roster;
  me: string | null;
  /** The picture of the room is covered. */
  covered: boolean;
}

export class RoomLoop {
  ticks = 0;
  /** Time that the last picture took, where the browser draws in software; s. */
  took = 0;
  private next = 0;
  private begun: number | null = null;

  constructor(
    private readonly stage: RoomStage,
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
      if (this.ready(now) || this.stage.blank) this.draw(now);
    };
    requestAnimationFrame(tick);
  }

  /** False while the last picture is under way, and for a moment after it: without a graphics card only. */
  private ready(now: number): boolean {
    if (this.stage.busy) return false;
    if (this.stage.software && this.begun !== null) {
      this.took = now - this.begun;
      this.next = Math.max(this.begun + SLOW, now + BREATHER * this.took);
      this.begun = null;
    }
    return now >= this.next;
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
    if (this.stage.draw(now, moved, anchor, this.calm() || this.stage.software, eyes)) this.begun = now;
  }
}
