// SPDX-License-Identifier: Apache-2.0
// Messages over the page: the banner of a lost connection, and short messages. Errors stay until they are closed, others
// until the page has been visible for some seconds.

import { button, byId, h, setText } from "./dom";
import { icon } from "./icons";
import type { ConnectionState } from "./retry";

/** The reason of a lost connection, and when the next try is. */
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

export type Level = "info" | "warning" | "error";

const MAX_SHOWN = 4;
const DURATION: Record<Level, number> = { info: 6, warning: 12, error: 0 }; // s; 0: until closed

/** Index of the message to remove when there are too many, oldest first: an error only when all are errors. */
export function toRemove(errors: readonly boolean[]): number {
  return Math.max(0, errors.indexOf(false));
}

/** Removes a message once the page has been visible for this time, s. */
function removeAfter(seconds: number, toast: HTMLElement): void {
  const timer = window.setInterval(() => {
    if (!document.hidden) seconds--;
    if (seconds > 0) return;
    window.clearInterval(timer);
    toast.remove();
  }, 1000);
}

export class Toasts {
  private readonly box = byId("toasts", HTMLElement);

  show(level: Level, words: string): void {
    if (!words) return;
    for (const t of [...this.box.children]) if (t.getAttribute("data-words") === words) t.remove();
    const remove = (): void => toast.remove();
    const label = "Close this message";
    const toast: HTMLElement = h(
      "div",
      { class: `toast ${level}`, "data-words": words },
      icon(level === "info" ? "info" : "warning"),
      h("p", {}, words),
      h("button", { class: "icon-button", "aria-label": label, onclick: remove }, icon("close")),
    );
    this.box.append(toast);
    while (this.box.children.length > MAX_SHOWN) {
      const shown = [...this.box.children];
      shown[toRemove(shown.map((t) => t.classList.contains("error")))]!.remove();
    }
    if (DURATION[level]) removeAfter(DURATION[level], toast);
  }
}
