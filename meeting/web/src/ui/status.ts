// SPDX-License-Identifier: Apache-2.0
// The state of the meeting in the header.

import { StateLine, type Level } from "#web/shared/state_line";
import type { LinkState } from "../link";
import type { LocalParticipant } from "../local_participant";

const STATES: Record<LinkState["kind"], readonly [string, Level]> = {
  closed: ["Not joined", ""],
  connecting: ["Connecting", "wait"],
  open: ["In the meeting", "good"],
  lost: ["Not connected", "bad"],
  refused: ["Refused", "bad"],
};

export class MeetingState extends StateLine {
  entry(): void {
    this.show("", "Not joined", "");
  }

  update(link: LinkState, count: number, me: LocalParticipant | null, locked: boolean): void {
    let words = "words" in link ? link.words : "";
    if (link.kind === "open") {
      words = count === 1 ? "One person is here." : `${count} people are here.`;
      if (!me) words += " You are watching.";
      else if (me.other?.kind === "tracker") words += " Your tracker moves your avatar.";
      else if (me.other) words += " You are also here in another window.";
      if (locked) words += " Locked: nobody new can join.";
    }
    const [name, level] = STATES[link.kind];
    this.show(level, name, words);
    const news = link.kind === "open" ? "You have joined the meeting." : `${name}. ${words}`;
    this.announceState(news, link.kind !== "connecting");
  }
}
