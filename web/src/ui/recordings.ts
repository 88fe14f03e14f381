// SPDX-License-Identifier: Apache-2.0
// Record, list, save, delete.

import type { Command, Recording, Status } from "../protocol";
import { button, byId, clock, h, icon, megabytes, renderOnce } from "./dom";

const SURE = 4000; // ms in which a second press deletes

export function fileAddress(recording: number, name: string): string {
  return `/recordings/${recording}/${encodeURIComponent(name)}`;
}

export class Recordings {
  private readonly list = byId("recordings", HTMLElement);
  private readonly record: HTMLButtonElement;
  private recording = false;

  constructor(
    private readonly send: (c: Command) => boolean,
    private readonly announce: (words: string) => void,
  ) {
    this.record = button("record", () => this.toggle());
  }

  toggle(): void {
    if (!this.record.disabled) this.send({ type: "record", on: !this.recording });
  }

  setStatus(s: Status): void {
    const on = s.recording !== null;
    if (on !== this.recording) this.announce(on ? "Recording." : "Recording ended.");
    this.recording = on;
    this.record.disabled = !on && !["tracking", "lost"].includes(s.phase);
    this.record.classList.toggle("on", on);
    byId("record-label", HTMLElement).textContent = s.recording
      ? `Stop ${clock(s.recording.seconds)}`
      : "Record";
    this.record.setAttribute("aria-label", on ? "Stop recording" : "Record");

    byId("recordings-empty", HTMLElement).hidden = s.recordings.length > 0;
    byId("count-recordings", HTMLElement).textContent = s.recordings.length
      ? String(s.recordings.length)
      : "";
    const newest = [...s.recordings].sort((a, b) => b.number - a.number);
    renderOnce(this.list, JSON.stringify(newest), () => newest.map((r) => this.row(r)));
  }

  disconnected(): void {
    this.record.disabled = true;
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
