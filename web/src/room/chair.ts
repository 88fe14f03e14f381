// SPDX-License-Identifier: Apache-2.0
// Changes of what the room is, by those who chair it. A broker does not say that it drops a message: a change is done when
// it has come back.

import { LIMITS, MAX_SEATS, MAX_TITLE, MAX_TITLE_BYTES, characters, writeRoom } from "./messages";
import type { RoomMessage } from "./messages";
import { plainLine } from "./names";

export type RoomChange = Partial<Pick<RoomMessage, "title" | "seats" | "epoch" | "locked">>;

/** So long a change may take to come back, ms. */
const PATIENCE = 5000;

interface Waiting {
  change: RoomChange;
  done: (words: string) => void;
}

export class RoomDesk {
  private waiting: Waiting[] = [];

  /** `tell`: false when there is no connection. */
  constructor(
    private readonly room: () => RoomMessage,
    private readonly tell: (room: RoomMessage) => Promise<boolean>,
  ) {}

  /** Empty when the room has taken it, or why not in words. */
  async ask(change: RoomChange): Promise<string> {
    // What was asked for before and has not come back is part of it.
    const wanted = Object.assign({ ...this.room() }, ...this.waiting.map((w) => w.change), change);
    if (writeRoom(wanted).byteLength > LIMITS.room) return "The room's words are too long.";
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
        () => one.done("The room did not take the change: the broker may not let you make it."),
        PATIENCE,
      );
      this.waiting.push(one);
      void this.tell(wanted).then((told) => {
        if (!told) one.done("The connection was lost before the room had the change. Try again.");
      });
    });
  }

  /** What the room is was told. */
  heard(): void {
    const room = this.room();
    const done = this.waiting.filter(({ change }) =>
      (Object.keys(change) as (keyof RoomChange)[]).every((key) => room[key] === change[key]),
    );
    for (const w of done) w.done("");
  }
}

/** What was typed, as a title; or why it is none, in words. */
export function readTitle(typed: string): { title: string } | { words: string } {
  const title = plainLine(typed, 10000);
  if (characters(title) > MAX_TITLE || new TextEncoder().encode(title).byteLength > MAX_TITLE_BYTES)
    return { words: `The title is too long: at most ${MAX_TITLE} characters.` };
  return title ? { title } : { words: "Give the room a title." };
}

/** What was typed, as a number of seats; null when it is none. */
export function readSeats(typed: string): number | null {
  const n = /^\s*\d{1,3}\s*$/.test(typed) ? Number(typed) : 0;
  return n >= 1 && n <= MAX_SEATS ? n : null;
}
