// SPDX-License-Identifier: Apache-2.0

import { byId, setText } from "./dom";

/** The state in the header, and what screen readers are to announce. */
export class StateLine {
  private readonly box = byId("state", HTMLElement);
  private readonly live = byId("live", HTMLElement);

  /** `phase` selects the colour of the dot (style sheets). */
  show(phase: string, name: string, words: string): void {
    this.box.dataset.phase = phase;
    setText(byId("state-name", HTMLElement), name);
    const text = byId("state-words", HTMLElement);
    setText(text, words);
    text.title = words;
  }

  /** Screen readers read it when they are idle. */
  announce(words: string): void {
    this.live.textContent = words;
  }
}
