// SPDX-License-Identifier: Apache-2.0
// No connection: says so, or why when that was told, and when the next try is.

import type { ConnectionState } from "../connection";
import { button, byId, h } from "./dom";

/** What stays as it was is not read out again. */
function put(e: Element, words: string): void {
  if (e.textContent !== words) e.textContent = words;
}

export class Banner {
  private readonly box = byId("banner", HTMLElement);
  private timer = 0;
  private state: ConnectionState = { kind: "connecting" };
  private failed = false;
  private told = ""; // why, when it was lost last

  constructor(tryNow: () => void) {
    button("banner-try", tryNow);
  }

  setState(s: ConnectionState): void {
    this.state = s;
    if (s.kind === "open") this.failed = false;
    if (s.kind === "lost") {
      this.failed = true;
      this.told = s.words;
    }
    this.box.hidden = !this.failed;
    window.clearInterval(this.timer);
    if (!this.failed) return;
    this.show();
    if (s.kind === "lost") this.timer = window.setInterval(() => this.show(), 500);
  }

  private show(): void {
    const seconds =
      this.state.kind === "lost" ? Math.ceil((this.state.retryAt - performance.now()) / 1000) : 0;
    const when = seconds > 1 ? `Trying again in ${seconds} s.` : "Trying again.";
    // The alert is read once; the seconds that run down are not.
    const words = byId("banner-words", HTMLElement);
    if (!words.firstChild) {
      words.append(h("b"), h("span"), h("span", { "aria-hidden": "true" }));
    }
    const [what, why, rest] = words.children;
    put(what!, `${this.told || "No connection to Telemime."} `);
    put(why!, this.told ? "" : "Is the program still running? ");
    rest!.textContent = when;
  }
}
