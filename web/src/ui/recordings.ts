// SPDX-License-Identifier: Apache-2.0
// Recordings: start and stop, list, download, delete.

import type { Command, Recording, Status } from "../live/protocol";
import { button, byId, confirmTwice, durationText, h, renderOnce, setCount, sizeText } from "../shared/dom";
import { icon, trashButton } from "../shared/icons";

const ANSWER_TIME = 3000; // ms in which a status confirms a request, but for a stop

/** What this page requested last, until a status confirms it. */
interface Request {
  on: boolean;
  at: number; // performance.now()
  /** The last status said the opposite: one that agrees is newer than the request. */
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
  private request: Request | null = null;

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
      this.announce("There is no connection to Telemime.");
      return;
    }
    this.request = { on, at: performance.now(), awaited: on !== this.recording };
    this.show();
  }

  setStatus(s: Status): void {
    const on = s.recording !== null;
    if (on !== this.recording) this.announce(on ? "Recording." : "Recording ended.");
    this.status = s;
    this.recording = on;
    if (this.request && on !== this.request.on) this.request.awaited = true;
    else if (this.request?.awaited) this.request = null; // confirmed
    this.show();

    byId("recordings-empty", HTMLElement).hidden = s.recordings.length > 0;
    setCount("recordings", s.recordings.length);
    const newest = [...s.recordings].sort((a, b) => b.number - a.number);
    renderOnce(this.list, JSON.stringify(newest), () => newest.map((r) => this.row(r)));
  }

  disconnected(): void {
    this.status = null;
    this.request = null;
    this.show();
  }

  /** Whether recording is requested or, without a request, going on. */
  private wanted(): boolean {
    const { request } = this;
    const closing = request?.on === false && this.recording; // the program completes the files, which may take minutes
    if (request && !closing && performance.now() - request.at > ANSWER_TIME) this.request = null;
    return this.request?.on ?? (this.status !== null && this.recording);
  }

  private show(): void {
    const s = this.status;
    const on = this.wanted();
    const label = this.request ? (on ? "Starting…" : "Stopping…") : on ? "Stop" : "Record";
    const time = s?.recording && !this.request ? ` ${durationText(s.recording.seconds)}` : "";
    this.record.disabled = !s || (!on && !["tracking", "lost"].includes(s.phase));
    this.record.classList.toggle("on", on);
    byId("record-label", HTMLElement).textContent = label + time;
    this.record.setAttribute("aria-label", this.request ? label : on ? "Stop recording" : "Record");
  }

  private row(r: Recording): HTMLElement {
    const label = `Delete recording ${r.number}`;
    const show = (asking: boolean): void => {
      remove.replaceChildren(asking ? "Delete?" : icon("trash"));
      remove.setAttribute("aria-label", asking ? `${label}? Press again to delete` : label);
      remove.classList.toggle("sure", asking);
    };
    const forget = (): void => {
      if (!this.send({ type: "forget", recording: r.number }))
        this.announce("There is no connection to Telemime.");
    };
    const remove = trashButton(label, confirmTwice(show, forget), { "data-focus": `d${r.number}` });
    const files = r.files.map((f) => {
      const extension = f.name.split(".").pop()?.toUpperCase() ?? f.name;
      return h(
        "a",
        {
          class: "file",
          href: fileAddress(r.number, f.name),
          download: `telemime-${r.number}-${f.name}`,
          title: `${f.name}, ${sizeText(f.bytes)}`,
          "aria-label": `Download ${f.name} of recording ${r.number}, ${sizeText(f.bytes)}`,
          "data-focus": `f${r.number}${f.name}`,
        },
        h("b", {}, extension),
        h("span", {}, sizeText(f.bytes)),
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
          h("span", { class: "soft" }, `${durationText(r.seconds)} · ${r.frames} frames`),
        ),
        remove,
      ),
      h("div", { class: "files" }, ...files),
    );
  }
}
