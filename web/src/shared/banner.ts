// SPDX-License-Identifier: Apache-2.0
// The banner of a lost connection: the reason, and when the next try is.

import { button, byId, h, setText } from "./dom";
import type { ConnectionState } from "./retry";

export class Banner {
  private readonly box = byId("banner", HTMLElement);
  private timer = 0;
  private state: ConnectionState = { kind: "connecting" };
  private failed = false;
  private reason = ""; // of the last loss

  constructor(tryNow: () => void) {
    button("banner-try", tryNow);
  }

  setState(s: ConnectionState): void {
    this.state = s;
    if (s.kind === "open") this.failed = false;
    if (s.kind === "lost") {
      this.failed = true;
      this.reason = s.words;
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
    // The alert is read once; the countdown is not.
    const words = byId("banner-words", HTMLElement);
    if (!words.firstChild) words.append(h("b"), h("span"), h("span", { "aria-hidden": "true" }));
    const [what, why, when] = words.children;
    setText(what!, `${this.reason || "No connection to Telemime."} `);
    setText(why!, this.reason ? "" : "Is the program still running? ");
    when!.textContent = seconds > 1 ? `Trying again in ${seconds} s.` : "Trying again.";
  }
}
