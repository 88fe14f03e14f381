// SPDX-License-Identifier: Apache-2.0
// Short words to the person. Errors stay until they are closed.

import type { Words } from "../protocol";
import { byId, h, icon } from "./dom";

const MOST = 4;
const STAYS = { info: 6000, warning: 12000, error: 0 } as const; // ms

const ICON = { info: "info", warning: "warning", error: "warning" } as const;

/** Which of too many messages goes, oldest first: an error only when all are errors. */
export function superfluous(errors: readonly boolean[]): number {
  return Math.max(0, errors.indexOf(false));
}

export class Toasts {
  private readonly box = byId("toasts", HTMLElement);

  say(level: Words["level"], words: string): void {
    if (!words) return;
    for (const t of [...this.box.children]) if (t.getAttribute("data-words") === words) t.remove();
    const close = h("button", { class: "icon-button", "aria-label": "Close this message" }, icon("close"));
    const toast = h(
      "div",
      { class: `toast ${level}`, "data-words": words },
      icon(ICON[level]),
      h("p", {}, words),
      close,
    );
    const remove = () => toast.remove();
    close.addEventListener("click", remove);
    this.box.append(toast);
    while (this.box.children.length > MOST) {
      const shown = [...this.box.children];
      shown[superfluous(shown.map((t) => t.classList.contains("error")))]!.remove();
    }
    if (STAYS[level]) window.setTimeout(remove, STAYS[level]);
  }
}
