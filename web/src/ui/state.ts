// SPDX-License-Identifier: Apache-2.0
// The state of the tracker, in the header and over the video.

import type { Phase, Status } from "../live/protocol";
import { byId } from "../shared/dom";
import { StateLine } from "../shared/state_line";

const NAMES: Record<Phase, string> = {
  opening: "Opening the camera",
  empty_room: "Setup",
  background: "Setup",
  person: "Waiting for you",
  tracking: "Tracking",
  lost: "Person not found",
  stopped: "No video",
  ended: "Ended",
};

/** Phases whose text also stands over the video. In the others the guide shows it. */
const CAPTIONED: readonly Phase[] = ["lost", "stopped", "ended"];

export class LiveState extends StateLine {
  private announced = "";

  setStatus(s: Status): void {
    this.show(s.phase, NAMES[s.phase], s.words);
    const caption = byId("camera-words", HTMLElement);
    caption.hidden = !CAPTIONED.includes(s.phase);
    caption.textContent = s.words || NAMES[s.phase];
    const words = `${NAMES[s.phase]}. ${s.words}`;
    if (words !== this.announced && CAPTIONED.concat("tracking").includes(s.phase)) this.announce(words);
    this.announced = words;
  }

  disconnected(): void {
    this.announced = "";
    byId("camera-words", HTMLElement).hidden = true;
    this.show("disconnected", "Not connected", "");
  }
}
