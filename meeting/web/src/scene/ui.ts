// SPDX-License-Identifier: Apache-2.0
// The picture of the meeting. The 3-D library is the largest part of it and is loaded separately, during the entry form.

import { byId } from "#web/shared/dom";
import type { DebugPose } from "../debug";
import type { Stroke } from "../messages";
import type { Rig } from "../rig";
import type { Roster } from "../roster";
import { drawsInSoftware } from "#web/shared/graphics";
import { BoardCanvas } from "./board_canvas";
import type { Cast, CastOptions } from "./cast";
import { control } from "./controls";
import { DAY, EVENING, type Palette } from "./palette";
import type { MeetingStage } from "./meeting_stage";
import { Tags } from "./tags";

/** What the scene shows. */
interface Shown {
  roster: Roster;
  me: string | null;
  /** The scene is covered. */
  covered: boolean;
}

export class SceneUi {
  readonly slate: BoardCanvas;
  /** Null before the 3-D library is loaded, or when the browser cannot draw in 3-D. */
  cast: Cast | null = null;
  private stage: MeetingStage | null = null;
  private ticks = 0;
  private readonly tags = new Tags(byId("tags", HTMLElement));
  private readonly dark = window.matchMedia("(prefers-color-scheme: dark)");
  private built = "";
  readonly options: CastOptions = { strangers: true, still: false };

  constructor(
    private readonly rig: Rig,
    private readonly what: () => Shown,
    strokes: () => readonly Stroke[],
    slateChanged: () => void,
  ) {
    const width = drawsInSoftware() ? 1024 : 2048;
    this.slate = new BoardCanvas(strokes, width, this.colours.slate, () => {
      this.stage?.boardChanged();
      slateChanged();
    });
    this.dark.addEventListener("change", () => {
      this.slate.setSlate(this.colours.slate);
      this.build();
    });
  }

  private get colours(): Palette {
    return this.dark.matches ? EVENING : DAY;
  }

  /** `complain` shows why there is no picture. */
  async open(complain: (words: string) => void): Promise<void> {
    const canvas = byId("meeting-canvas", HTMLCanvasElement);
    const parts = await Promise.all([
      import("./meeting_stage"),
      import("./cast"),
      import("./avatar_library"),
    ]).catch(() => null);
    const missing = (why: string): void => {
      const none = byId("meeting-none", HTMLElement);
      none.hidden = false;
      none.textContent = `${why} The side panel and the blackboard work.`;
      complain(`${why} Avatars are not shown. All else works.`);
    };
    if (!parts) {
      missing("The part of this page that draws the meeting did not load: load the page again.");
      return;
    }
    const [{ MeetingStage }, { Cast }, { AvatarLibrary }] = parts;
    try {
      const view = byId("meeting-view", HTMLElement);
      const stage = new MeetingStage(canvas, view, this.tags, this.rig, this.slate.canvas);
      const cast = new Cast(stage, new AvatarLibrary(), this.tags, this.options, (n) =>
        view.classList.toggle("loading", n > 0),
      );
      this.stage = stage;
      this.cast = cast;
      control(canvas, this.rig);
      const { roster, me } = this.what();
      this.follow(roster, me);
      const tick = (): void => {
        requestAnimationFrame(tick); // the browser calls nothing while the page is hidden
        this.ticks++;
        const now = performance.now() / 1000;
        if (stage.ready(now)) this.draw(stage, cast, now);
      };
      requestAnimationFrame(tick);
    } catch (e) {
      console.warn("3-D:", e);
      missing("This browser cannot draw in 3-D (WebGL is off).");
    }
  }

  /** In an animation frame: the poses, then the picture. */
  private draw(stage: MeetingStage, cast: Cast, now: number): void {
    const { roster, me, covered } = this.what();
    this.tags.step(now);
    if (covered) {
      stage.paused();
      return;
    }
    const moved = cast.show(roster, now);
    const anchor = cast.anchor(me, roster);
    const eyes = this.rig.view === "eyes" && anchor ? me : null;
    cast.hide(eyes);
    stage.draw(now, moved, anchor, this.options.still || stage.software, eyes);
  }

  private build(): void {
    const { furtherSeats, meeting } = this.what().roster;
    const key = `${meeting.seats} ${furtherSeats} ${this.dark.matches}`;
    if (!this.stage || key === this.built) return;
    this.built = key;
    this.stage.build(meeting.seats, furtherSeats, this.colours);
  }

  /** Call it after a change of participants or of the meeting. */
  follow(roster: Roster, me: string | null): void {
    this.build();
    this.cast?.follow(roster, me);
  }

  touch(): void {
    this.stage?.touch();
  }

  showMessage(id: string, text: string): void {
    this.tags.showMessage(id, text, performance.now() / 1000);
    this.stage?.touch();
  }

  /** The shown poses of those who have both motion and an avatar. */
  poses(roster: Roster): Record<string, DebugPose> {
    const out: Record<string, DebugPose> = {};
    for (const p of roster.here) {
      const shown = p.stream.shown;
      const bones = Object.entries(this.cast?.read(p.id) ?? {}).map(([b, r]) => [b, r.local] as const);
      const face = this.cast?.face(p.id) ?? {};
      if (shown && bones.length) out[p.id] = { ...shown, bones: Object.fromEntries(bones), face };
    }
    return out;
  }

  get counters(): Record<string, number> {
    return {
      ...this.stage?.counters,
      ticks: this.ticks,
      software: Number(this.stage?.software ?? false),
    };
  }
}
