// SPDX-License-Identifier: Apache-2.0
// Single-key shortcuts and the dialog that lists them.

import { button, byId, h } from "./dom";

export interface Shortcut {
  key: string; // as KeyboardEvent.key; a capital letter is pressed with Shift
  label: string;
  run: () => void;
}

/** Whether the element takes typed text. */
function takesText(target: EventTarget | null): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target instanceof HTMLInputElement && ["radio", "checkbox"].includes(target.type)) return false;
  return target.closest("input, textarea, select, [contenteditable]") !== null;
}

/** Whether this key was pressed: a capital letter with Shift, others without. Caps Lock changes nothing. */
function isPressed(key: string, e: KeyboardEvent): boolean {
  const small = key.toLowerCase();
  if (small === key.toUpperCase()) return e.key === key; // no letter: some keyboards need Shift for it
  return e.key.toLowerCase() === small && e.shiftKey === (key !== small);
}

export class Shortcuts {
  private readonly dialog = byId("help-dialog", HTMLDialogElement);

  /** `settings.keys`: whether shortcuts are on; `save` stores it. `others`: keys that the dialog lists and views handle. */
  constructor(
    private readonly list: readonly Shortcut[],
    private readonly settings: { keys: boolean },
    save: () => void,
    others: readonly [string, string][],
  ) {
    const all: [string, string][] = [
      ...list.map(({ key, label }): [string, string] => [
        key === key.toLowerCase() ? key : `Shift ${key}`,
        label,
      ]),
      ["?", "Show this help"],
      ["Esc", "Close a dialog or the side panel"],
      ...others,
    ];
    byId("help-list", HTMLElement).replaceChildren(
      ...all.map(([key, label]) => h("div", {}, h("dt", {}, h("kbd", {}, key)), h("dd", {}, label))),
    );
    const box = byId("help-keys", HTMLInputElement);
    box.checked = settings.keys;
    box.addEventListener("change", () => {
      settings.keys = box.checked;
      save();
    });
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
    if (e.ctrlKey || e.altKey || e.metaKey || e.repeat || takesText(e.target)) return;
    if (this.dialog.open || !this.settings.keys) return;
    const run = e.key === "?" ? () => this.help() : this.list.find((x) => isPressed(x.key, e))?.run;
    if (!run) return;
    e.preventDefault();
    run();
  }
}
