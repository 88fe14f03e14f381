// SPDX-License-Identifier: Apache-2.0
// Record, list, save, delete.

import type { Command, Recording, Status } from "../protocol";
import { button, byId, clock, h, icon, megabytes, renderOnce } from "./dom";

const SURE = 4000; // ms in which a second press deletes
const ANSWER = 3000; // ms in which a status shows what was asked for, or it did not come about

/** What this page asked for last, until a status shows it. */
interface Wish {
  on: boolean;
  at: number; // performance.now()
  /** A status with the opposite came last: one that fits is news, and was not on its way before the wish. */
  awaited: boolean;
}

export function fileAddress(recording: number, name: string): string {
  return `/recordings/${recording}/${encodeURIComponent(name)}`;
}

export class Recordings {
  private readonly list = byId("recordings", HTMLElement);
  private readonly record: HTMLButtonElement;
  private status: Status | null = null;
  private recording = false;
  private wish: Wish | null = null;

  constructor(
    private readonly send: (c: Command) => boolean,
    private readonly announce: (words: string) => void,
  ) {
    this.record = button("record", () => this.toggle());
  }

  toggle(): void {
    if (this.record.disabled) return;
    const on = !this.wanted();
    if (!this.send({ type: "record", on })) {
      this.announce("There is no connection to Telemime at the moment.");
      return;
    }
    this.wish = { on, at: performance.now(), awaited: on !== this.recording };
    this.show();
  }

  setStatus(s: Status): void {
    const on = s.recording !== null;
    if (on !== this.recording) this.announce(on ? "Recording." : "Recording ended.");
    this.status = s;
    this.recording = on;
    if (this.wish && on !== this.wish.on) this.wish.awaited = true;
    else if (this.wish?.awaited) this.wish = null; // it has come about
    this.show();

    byId("recordings-empty", HTMLElement).hidden = s.recordings.length > 0;
    byId("count-recordings", HTMLElement).textContent = s.recordings.length
      ? String(s.recordings.length)
      : "";
    const newest = [...s.recordings].sort((a, b) => b.number - a.number);
    renderOnce(this.list, JSON.stringify(newest), () => newest.map((r) => this.row(r)));
  }

  disconnected(): void {
    this.status = null;
    this.wish = null;
    this.show();
  }

  /** Whether to record, as far as this page knows. */
  private wanted(): boolean {
    if (this.wish && performance.now() - this.wish.at > ANSWER) this.wish = null;
    return this.wish?.on ?? this.recording;
  }

  private show(): void {
    const s = this.status;
    const on = this.wanted();
    const label = this.wish ? (on ? "Starting…" : "Stopping…") : on ? "Stop" : "Record";
    const time = s?.recording && !this.wish ? ` ${clock(s.recording.seconds)}` : "";
    this.record.disabled = !s || (!on && !["tracking", "lost"].includes(s.phase));
    this.record.classList.toggle("on", on);
    byId("record-label", HTMLElement).textContent = label + time;
    this.record.setAttribute("aria-label", this.wish ? label : on ? "Stop recording" : "Record");
  }

  private row(r: Recording): HTMLElement {
    const remove = h(
      "button",
      {
        class: "icon-button",
        "aria-label": `Delete recording ${r.number}`,
        title: "Delete",
        "data-focus": `d${r.number}`,
      },
      icon("trash"),
    );
    let sure = 0;
    remove.addEventListener("click", () => {
      if (sure) {
        window.clearTimeout(sure);
        this.send({ type: "forget", recording: r.number });
        return;
      }
      remove.replaceChildren("Delete?");
      remove.setAttribute("aria-label", `Delete recording ${r.number}? Press again to delete`);
      remove.classList.add("sure");
      sure = window.setTimeout(() => {
        sure = 0;
        remove.replaceChildren(icon("trash"));
        remove.setAttribute("aria-label", `Delete recording ${r.number}`);
        remove.classList.remove("sure");
      }, SURE);
    });
    const files = r.files.map((f) => {
      const end = f.name.split(".").pop()?.toUpperCase() ?? f.name;
      return h(
        "a",
        {
          class: "file",
          href: fileAddress(r.number, f.name),
          download: `telemime-${r.number}-${f.name}`,
          title: `${f.name}, ${megabytes(f.bytes)}`,
          "aria-label": `Save ${f.name} of recording ${r.number}, ${megabytes(f.bytes)}`,
          "data-focus": `f${r.number}${f.name}`,
        },
        h("b", {}, end),
        h("span", {}, megabytes(f.bytes)),
      );
    });
    return h(
      "li",
      { class: "recording" },
      h(
        "div",
        { class: "row" },
        h(
          "div",
          { class: "row-text" },
          h("b", {}, `Recording ${r.number}`),
          h("span", { class: "soft" }, `${clock(r.seconds)} · ${r.frames} frames`),
        ),
        remove,
      ),
      h("div", { class: "files" }, ...files),
    );
  }
}
