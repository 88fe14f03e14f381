// SPDX-License-Identifier: Apache-2.0
// The side panel's page of the room: what it is, its chair's controls, and the command for one's own tracker.

import { button, byId } from "../../ui/dom";
import { readSeats, readTitle, type RoomChange } from "../chair";
import { MAX_TITLE, type RoomMessage } from "../messages";
import { plainLine } from "../names";

interface Uses {
  /** Empty when the room has taken it, or why not in words. */
  alter: (change: RoomChange) => Promise<string>;
  /** With the password; null when there is none. */
  command: () => string | null;
  announce: (words: string) => void;
}

export class RoomTab {
  private readonly title = byId("room-title", HTMLInputElement);
  private readonly seats = byId("room-seats", HTMLInputElement);
  private readonly words = byId("chair-words", HTMLElement);
  private readonly locked = byId("room-locked", HTMLInputElement);
  private readonly command = byId("camera-command", HTMLElement);
  private readonly copied = byId("camera-words", HTMLElement);
  private readonly showButton: HTMLButtonElement;
  private readonly copyButton: HTMLButtonElement;
  private room: RoomMessage | null = null;
  private number = 0; // of the newest change: what an older one comes to is not told any more

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
    this.room = null;
    this.tell("");
    this.reveal(false);
    byId("chair", HTMLElement).hidden = !chair;
    byId("camera", HTMLElement).hidden = !camera;
    byId("camera-look", HTMLElement).hidden = look;
    byId("room-badge", HTMLElement).hidden = true;
  }

  /** What the room is now. What the person is typing stays. */
  show(room: RoomMessage): void {
    if (room === this.room) return;
    const before = this.room;
    const title = plainLine(room.title, MAX_TITLE);
    if (!before || this.title.value === plainLine(before.title, MAX_TITLE)) this.title.value = title;
    if (!before || this.seats.value === String(before.seats)) this.seats.value = String(room.seats);
    this.locked.checked = room.locked;
    this.room = room;
    byId("room-badge", HTMLElement).hidden = !room.locked;
    byId("room-is", HTMLElement).textContent =
      `${title || "This room"}: ${room.seats === 1 ? "one seat" : `${room.seats} seats`} at the table. ` +
      (room.locked
        ? "It is locked: nobody new comes in. Who was in before can come back."
        : "It is open to all who have a link.");
    if (before && before.locked !== room.locked)
      this.uses.announce(
        room.locked ? "The room is locked: nobody new comes in." : "The room is not locked any more.",
      );
  }

  /** The tracker of this person is here. */
  tracked(on: boolean): void {
    byId("camera-here", HTMLElement).hidden = !on;
  }

  private save(): void {
    const room = this.room;
    if (!room) return;
    const title = readTitle(this.title.value);
    const seats = readSeats(this.seats.value);
    this.title.setAttribute("aria-invalid", String("words" in title));
    this.seats.setAttribute("aria-invalid", String(seats === null));
    if ("words" in title) {
      this.title.focus();
      return this.tell(title.words, true);
    }
    if (seats === null) {
      this.seats.focus();
      return this.tell("The number of seats is from 1 to 100.", true);
    }
    this.title.value = title.title;
    this.seats.value = String(seats);
    const change: RoomChange = {};
    if (title.title !== plainLine(room.title, MAX_TITLE)) change.title = title.title;
    if (seats !== room.seats) change.seats = seats;
    if (Object.keys(change).length === 0) return this.tell("Nothing has changed.");
    void this.ask(change, "Saved.");
  }

  private async lock(): Promise<void> {
    const locked = this.locked.checked;
    await this.ask({ locked }, locked ? "Locked." : "Unlocked.");
    this.locked.checked = this.room?.locked ?? false;
  }

  private async ask(change: RoomChange, done: string): Promise<void> {
    const number = ++this.number;
    this.tell("Telling the room …");
    const refused = await this.uses.alter(change);
    if (number === this.number) this.tell(refused || done, refused !== "");
  }

  private tell(words: string, wrong = false): void {
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
      this.copied.textContent = "It is marked: copy it with Ctrl+C.";
    }
  }
}
