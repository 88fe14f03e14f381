// SPDX-License-Identifier: Apache-2.0
// Short messages over the page. Errors stay until they are closed.

import { byId, h } from "./dom";
import { icon } from "./icons";

export type Level = "info" | "warning" | "error";

const MAX_SHOWN = 4;
const DURATION: Record<Level, number> = { info: 6000, warning: 12000, error: 0 }; // ms; 0: until closed

/** Index of the message to remove when there are too many, oldest first: an error only when all are errors. */
export function toRemove(errors: readonly boolean[]): number {
  return Math.max(0, errors.indexOf(false));
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
    if (DURATION[level]) window.setTimeout(remove, DURATION[level]);
  }
}
