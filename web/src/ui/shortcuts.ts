// SPDX-License-Identifier: Apache-2.0
// Single-key shortcuts and the dialog that lists them.

import { button, byId, h } from "./dom";

export interface Shortcut {
  key: string; // as KeyboardEvent.key
  label: string;
  run: () => void;
}

/** For the list: keys of the avatar view, which has them while it has the focus. */
const IN_THE_VIEW: [string, string][] = [
  ["Arrow keys", "Turn the avatar (when its view has the focus)"],
  ["+ and -", "Closer, farther"],
];

function typing(target: EventTarget | null): boolean {
  return target instanceof HTMLElement &&
    target.closest("input, textarea, select, [contenteditable]") !== null
    ? !(target instanceof HTMLInputElement && ["radio", "checkbox"].includes(target.type))
    : false;
}

export class Shortcuts {
  private readonly dialog = byId("help-dialog", HTMLDialogElement);

  constructor(
    private readonly list: readonly Shortcut[],
    private readonly on: { get: () => boolean; set: (on: boolean) => void },
    inTheView: readonly [string, string][] = IN_THE_VIEW,
  ) {
    const rows = byId("help-list", HTMLElement);
    const all: [string, string][] = [
      ...list.map((s): [string, string] => [
        s.key === s.key.toLowerCase() ? s.key : `Shift ${s.key}`,
        s.label,
      ]),
      ["?", "This help"],
      ["Esc", "Close a dialog or the side panel"],
      ...inTheView,
    ];
    rows.replaceChildren(
      ...all.map(([key, label]) => h("div", {}, h("dt", {}, h("kbd", {}, key)), h("dd", {}, label))),
    );
    const box = byId("help-keys", HTMLInputElement);
    box.checked = on.get();
    box.addEventListener("change", () => on.set(box.checked));
    button("help", () => this.help());
    button("help-close", () => this.dialog.close());
    this.dialog.addEventListener("click", (e) => {
      if (e.target === this.dialog) this.dialog.close();
    });
    document.addEventListener("keydown", (e) => this.key(e));
  }

  help(): void {
    if (!this.dialog.open) this.dialog.showModal();
  }

  private key(e: KeyboardEvent): void {
    if (e.ctrlKey || e.altKey || e.metaKey || e.repeat || typing(e.target)) return;
    if (this.dialog.open || !this.on.get()) return;
    if (e.key === "?") {
      e.preventDefault();
      this.help();
      return;
    }
    const s = this.list.find((x) => x.key === e.key);
    if (!s) return;
    e.preventDefault();
    s.run();
  }
}
