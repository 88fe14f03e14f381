// SPDX-License-Identifier: Apache-2.0
// The state of the tracker, in the header and over the video.

import type { Phase, Status } from "../live/protocol";
import { byId } from "../shared/dom";
import { StateLine, type Level } from "../shared/state_line";

const STATES: Record<Phase, readonly [string, Level]> = {
  opening: ["Opening the camera", ""],
  empty_room: ["Setup", "wait"],
  background: ["Setup", "wait"],
  person: ["Waiting for you", "wait"],
  tracking: ["Tracking", "good"],
  lost: ["Person not found", "wait"],
  stopped: ["No video", "bad"],
  ended: ["Ended", ""],
};

/** Phases whose text also stands over the video. In the others the guide shows it. */
const CAPTIONED: readonly Phase[] = ["lost", "stopped", "ended"];

export class LiveState extends StateLine {
  setStatus(s: Status): void {
    const [name, level] = STATES[s.phase];
    this.show(level, name, s.words);
    const caption = byId("camera-words", HTMLElement);
    caption.hidden = !CAPTIONED.includes(s.phase);
    caption.textContent = s.words || name;
    this.announceState(`${name}. ${s.words}`, CAPTIONED.concat("tracking").includes(s.phase));
  }

  disconnected(): void {
    this.announceState("", false);
    byId("camera-words", HTMLElement).hidden = true;
    this.show("bad", "Not connected", "");
  }
}
