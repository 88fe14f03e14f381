// SPDX-License-Identifier: Apache-2.0
// Short words to the person. Errors stay until they are closed.

import type { Words } from "../protocol";
import { byId, h, icon } from "./dom";

const MOST = 4;
const STAYS = { info: 6000, warning: 12000, error: 0 } as const; // ms

const ICON = { info: "info", warning: "warning", error: "warning" } as const;

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
    while (this.box.children.length > MOST) this.box.firstElementChild?.remove();
    if (STAYS[level]) window.setTimeout(remove, STAYS[level]);
  }
}
