// SPDX-License-Identifier: Apache-2.0
// The side panel's tab of the meeting: its state, the controls of its chairs, and the command for a tracker.

import { button, byId } from "#web/shared/dom";
import { readSeats, readTitle, type MeetingChange } from "../chair_requests";
import { MAX_TITLE, type MeetingMessage } from "../messages";
import { plainLine } from "../names";

interface Uses {
  /** Gives an empty string when the meeting has accepted it, or the reason why not. */
  alter: (change: MeetingChange) => Promise<string>;
  /** With the password; null when there is none. */
  command: () => string | null;
  announce: (words: string) => void;
}

export class MeetingTab {
  private readonly title = byId("meeting-title", HTMLInputElement);
  private readonly seats = byId("meeting-seats", HTMLInputElement);
  private readonly words = byId("chair-words", HTMLElement);
  private readonly locked = byId("meeting-locked", HTMLInputElement);
  private readonly command = byId("camera-command", HTMLElement);
  private readonly copied = byId("camera-words", HTMLElement);
  private readonly showButton: HTMLButtonElement;
  private readonly copyButton: HTMLButtonElement;
  private meeting: MeetingMessage | null = null;
  private number = 0; // of the newest change: results of older ones are not shown

  constructor(private readonly uses: Uses) {
    byId("chair-form", HTMLFormElement).addEventListener("submit", (e) => {
      e.preventDefault();
      this.save();
    });
    this.locked.addEventListener("change", () => void this.lock());
    this.showButton = button("camera-show", () => this.reveal(this.command.hidden));
    this.copyButton = button("camera-copy", () => void this.copy());
    this.enter(false, false, false);
  }

  /** The person is in, or out. Nothing of an earlier account stays. `look`: the tracker can have the person's avatar. */
  enter(chair: boolean, camera: boolean, look: boolean): void {
    this.number++;
    this.meeting = null;
    this.report("");
    this.reveal(false);
    byId("chair", HTMLElement).hidden = !chair;
    byId("camera", HTMLElement).hidden = !camera;
    byId("camera-look", HTMLElement).hidden = look;
    byId("meeting-badge", HTMLElement).hidden = true;
  }

  /** What the meeting is now. What the person is typing stays. */
  show(meeting: MeetingMessage): void {
    if (meeting === this.meeting) return;
    const before = this.meeting;
    const title = plainLine(meeting.title, MAX_TITLE);
    if (!before || this.title.value === plainLine(before.title, MAX_TITLE)) this.title.value = title;
    if (!before || this.seats.value === String(before.seats)) this.seats.value = String(meeting.seats);
    this.locked.checked = meeting.locked;
    this.meeting = meeting;
    byId("meeting-badge", HTMLElement).hidden = !meeting.locked;
    byId("meeting-is", HTMLElement).textContent =
      `${title || "This meeting"}: ${meeting.seats === 1 ? "one seat" : `${meeting.seats} seats`} at the table. ` +
      (meeting.locked
        ? "It is locked: nobody new can join. Earlier participants can come back."
        : "Anyone with a link can join.");
    if (before && before.locked !== meeting.locked)
      this.uses.announce(
        meeting.locked ? "The meeting is locked: nobody new can join." : "The meeting is unlocked.",
      );
  }

  /** The tracker of this person is here. */
  tracked(on: boolean): void {
    byId("camera-here", HTMLElement).hidden = !on;
  }

  private save(): void {
    const meeting = this.meeting;
    if (!meeting) return;
    const title = readTitle(this.title.value);
    const seats = readSeats(this.seats.value);
    this.title.setAttribute("aria-invalid", String("words" in title));
    this.seats.setAttribute("aria-invalid", String(seats === null));
    if ("words" in title) {
      this.title.focus();
      return this.report(title.words, true);
    }
    if (seats === null) {
      this.seats.focus();
      return this.report("The number of seats is from 1 to 100.", true);
    }
    this.title.value = title.title;
    this.seats.value = String(seats);
    const change: MeetingChange = {};
    if (title.title !== plainLine(meeting.title, MAX_TITLE)) change.title = title.title;
    if (seats !== meeting.seats) change.seats = seats;
    if (Object.keys(change).length === 0) return this.report("Nothing has changed.");
    void this.ask(change, "Saved.");
  }

  private async lock(): Promise<void> {
    const locked = this.locked.checked;
    await this.ask({ locked }, locked ? "Locked." : "Unlocked.");
    this.locked.checked = this.meeting?.locked ?? false;
  }

  private async ask(change: MeetingChange, done: string): Promise<void> {
    const number = ++this.number;
    this.report("Saving…");
    const refused = await this.uses.alter(change);
    if (number === this.number) this.report(refused || done, refused !== "");
  }

  private report(words: string, wrong = false): void {
    this.words.classList.toggle("error", wrong);
    this.words.classList.toggle("soft", !wrong);
    this.words.textContent = words;
  }

  private reveal(on: boolean): void {
    const command = on ? this.uses.command() : null;
    this.command.textContent = command ?? "";
    this.command.hidden = this.copyButton.hidden = command === null;
    this.showButton.textContent = command === null ? "Show the command" : "Hide";
    this.showButton.setAttribute("aria-expanded", String(command !== null));
    this.copied.textContent = "";
  }

  private async copy(): Promise<void> {
    try {
      await navigator.clipboard.writeText(this.command.textContent ?? "");
      this.copied.textContent = "Copied.";
    } catch {
      // Without HTTPS browsers do not let pages copy.
      getSelection()?.selectAllChildren(this.command);
      this.copied.textContent = "Selected: copy it with Ctrl+C.";
    }
  }
}
