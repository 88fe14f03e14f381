// SPDX-License-Identifier: Apache-2.0
// No connection: says so, and when the next try is.

import type { ConnectionState } from "../connection";
import { button, byId } from "./dom";

export class Banner {
  private readonly box = byId("banner", HTMLElement);
  private timer = 0;
  private state: ConnectionState = { kind: "connecting" };
  private failed = false;

  /** `what` went wrong, and perhaps why. */
  constructor(
    tryNow: () => void,
    private readonly what = () => "No connection to Telemime.",
    private readonly why = "Is the program still running?",
  ) {
    button("banner-try", tryNow);
  }

  setState(s: ConnectionState): void {
    this.state = s;
    if (s.kind === "open") this.failed = false;
    if (s.kind === "lost") this.failed = true;
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
      const what = document.createElement("b");
      const rest = document.createElement("span");
      rest.setAttribute("aria-hidden", "true");
      words.append(what, `${this.why} `, rest);
    }
    const what = `${this.what()} `;
    if (words.firstElementChild!.textContent !== what) words.firstElementChild!.textContent = what;
    words.lastElementChild!.textContent = when;
  }
}
