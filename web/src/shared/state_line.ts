// SPDX-License-Identifier: Apache-2.0

import { byId, setText } from "./dom";

export type Level = "good" | "wait" | "bad" | "";

/** The state in the header, and what screen readers are to announce. */
export class StateLine {
  private readonly dot = byId("state-dot", HTMLElement);
  private readonly live = byId("live", HTMLElement);
  private last = "";

  /** `level`: the colour of the dot. */
  show(level: Level, name: string, words: string): void {
    this.dot.className = `dot ${level}`;
    setText(byId("state-name", HTMLElement), name);
    const text = byId("state-words", HTMLElement);
    setText(text, words);
    text.title = words;
  }

  /** Screen readers read it when they are idle. */
  announce(words: string): void {
    this.live.textContent = words;
  }

  /** Announces a new state, if it is `important`. */
  protected announceState(words: string, important: boolean): void {
    if (words !== this.last && important) this.announce(words);
    this.last = words;
  }
}
