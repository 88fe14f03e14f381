// SPDX-License-Identifier: Apache-2.0
// Changes of the meeting by its chairs. A broker does not report that it drops a message: a change is done when it comes back.

import { LIMITS, MAX_SEATS, MAX_TITLE, MAX_TITLE_BYTES, characters, writeMeeting } from "./messages";
import type { MeetingMessage } from "./messages";
import { plainLine } from "./names";

export type MeetingChange = Partial<Pick<MeetingMessage, "title" | "seats" | "epoch" | "locked">>;

/** Time for a change to come back, ms. */
const TIMEOUT = 5000;

interface Waiting {
  change: MeetingChange;
  done: (words: string) => void;
}

export class ChairRequests {
  private waiting: Waiting[] = [];

  /** `publish` gives false when there is no connection. */
  constructor(
    private readonly meeting: () => MeetingMessage,
    private readonly publish: (meeting: MeetingMessage) => Promise<boolean>,
  ) {}

  /** Requests a change. Gives an empty string when it is done, or the reason why not. */
  async request(change: MeetingChange): Promise<string> {
    // Changes that have not come back yet are part of it.
    const wanted = Object.assign({ ...this.meeting() }, ...this.waiting.map((w) => w.change), change);
    if (writeMeeting(wanted).byteLength > LIMITS.meeting) return "The title is too long.";
    return new Promise((resolve) => {
      const one: Waiting = {
        change,
        done: (words) => {
          clearTimeout(timer);
          this.waiting = this.waiting.filter((w) => w !== one);
          resolve(words);
        },
      };
      const timer = setTimeout(
        () => one.done("The change was not accepted: the broker may not allow you to make it."),
        TIMEOUT,
      );
      this.waiting.push(one);
      void this.publish(wanted).then((sent) => {
        if (!sent) one.done("The connection was lost before the change was sent. Try again.");
      });
    });
  }

  /** The meeting has been published. */
  received(): void {
    const meeting = this.meeting();
    const done = this.waiting.filter(({ change }) =>
      (Object.keys(change) as (keyof MeetingChange)[]).every((key) => meeting[key] === change[key]),
    );
    for (const w of done) w.done("");
  }
}

/** The typed text as a title, or the reason why it is none. */
export function readTitle(typed: string): { title: string } | { words: string } {
  const title = plainLine(typed, 10000);
  if (characters(title) > MAX_TITLE || new TextEncoder().encode(title).byteLength > MAX_TITLE_BYTES)
    return { words: `The title is too long: at most ${MAX_TITLE} characters.` };
  return title ? { title } : { words: "Enter a title." };
}

/** The typed text as a number of seats; null when it is none. */
export function readSeats(typed: string): number | null {
  const n = /^\s*\d{1,3}\s*$/.test(typed) ? Number(typed) : 0;
  return n >= 1 && n <= MAX_SEATS ? n : null;
}
