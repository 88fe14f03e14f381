// SPDX-License-Identifier: Apache-2.0
// The line that says how it stands with the room, on the screen and to screen readers.

import { byId } from "../../ui/dom";
import type { LinkState } from "../link";
import type { Me } from "../me";

const NAMES: Record<LinkState["kind"], string> = {
  closed: "At the door",
  connecting: "Connecting",
  open: "In the room",
  lost: "Not connected",
  refused: "Not let in",
};

export class StatusLine {
  private readonly box = byId("state", HTMLElement);
  private readonly live = byId("live", HTMLElement);
  private said = "";

  door(): void {
    this.put("door", "At the door", "");
  }

  show(link: LinkState, count: number, me: Me | null, locked: boolean): void {
    let words = "words" in link ? link.words : "";
    if (link.kind === "open") {
      words = count === 1 ? "One person is here." : `${count} people are here.`;
      if (!me) words += " You watch.";
      else if (me.other?.kind === "tracker") words += " Your tracker moves your avatar.";
      else if (me.other) words += " You are here in another window, too.";
      if (locked) words += " Locked: nobody new comes in.";
    }
    this.put(link.kind, NAMES[link.kind], words);
    const news = link.kind === "open" ? "You are in the room." : `${NAMES[link.kind]}. ${words}`;
    if (news !== this.said && link.kind !== "connecting") this.announce(news);
    this.said = news;
  }

  /** Said by screen readers when they have nothing else to say. */
  announce(words: string): void {
    this.live.textContent = words;
  }

  private put(phase: string, name: string, words: string): void {
    this.box.dataset.phase = phase;
    const set = (id: string, text: string): void => {
      const e = byId(id, HTMLElement);
      if (e.textContent !== text) e.textContent = text;
      e.title = text;
    };
    set("state-name", name);
    set("state-words", words);
  }
}
