// SPDX-License-Identifier: Apache-2.0
// The line that says what goes on, on the screen and to screen readers.

import type { Phase, Status } from "../protocol";
import { byId } from "./dom";

const NAMES: Record<Phase, string> = {
  opening: "Opening the camera",
  empty_room: "Getting ready",
  background: "Getting ready",
  person: "Waiting for you",
  tracking: "Tracking",
  lost: "I do not see you",
  stopped: "No pictures",
  ended: "Ended",
};

/** Phases in which the words also stand over the picture (the guide says them in the others). */
const CAPTIONED: readonly Phase[] = ["lost", "stopped", "ended"];

export class StateLine {
  private readonly box = byId("state", HTMLElement);
  private readonly live = byId("live", HTMLElement);
  private said = "";

  setStatus(s: Status): void {
    this.show(s.phase, NAMES[s.phase], s.words);
    const caption = byId("camera-words", HTMLElement);
    caption.hidden = !CAPTIONED.includes(s.phase);
    caption.textContent = s.words || NAMES[s.phase];
    const words = `${NAMES[s.phase]}. ${s.words}`;
    if (words !== this.said && CAPTIONED.concat("tracking").includes(s.phase)) this.announce(words);
    this.said = words;
  }

  disconnected(): void {
    this.said = "";
    byId("camera-words", HTMLElement).hidden = true;
    this.show("disconnected", "Not connected", "");
  }

  /** Said by screen readers when they have nothing else to say. */
  announce(words: string): void {
    this.live.textContent = words;
  }

  private show(phase: string, name: string, words: string): void {
    this.box.dataset.phase = phase;
    byId("state-name", HTMLElement).textContent = name;
    const text = byId("state-words", HTMLElement);
    text.textContent = words;
    text.title = words;
  }
}
