// SPDX-License-Identifier: Apache-2.0
// The side panel: beside the page when that is wide, over it when it is narrow; and its tabs.

import { button, byId } from "./dom";

/** What is stored of a panel. */
export interface PanelSettings {
  panelClosed: boolean; // on a wide page
  tab: string;
}

export class Panel<T extends PanelSettings> {
  private readonly panel = byId("panel", HTMLElement);
  private readonly toggleButton: HTMLButtonElement;
  private readonly tabs: HTMLElement[];
  private readonly wide = window.matchMedia("(min-width: 1200px)");
  private over = false; // opened over the page

  constructor(
    private readonly settings: T,
    /** Called after each change of the settings or of what is visible. */
    private readonly save: () => void,
  ) {
    this.tabs = [...this.panel.querySelectorAll<HTMLElement>('[role="tab"]')];
    for (const t of this.tabs) t.addEventListener("click", () => this.choose(t.dataset.tab!));
    this.panel
      .querySelector('[role="tablist"]')!
      .addEventListener("keydown", (e) => this.tabKey(e as KeyboardEvent));
    this.choose(settings.tab);
    this.toggleButton = button("panel-toggle", () => this.toggle());
    button("panel-close", () => this.toggle());
    this.wide.addEventListener("change", () => {
      this.over = false;
      this.refresh();
      this.save();
    });
    document.addEventListener("keydown", (e) => {
      if (e.key === "Escape" && this.over && !document.querySelector("dialog[open]")) this.toggle();
    });
    document.addEventListener("pointerdown", (e) => {
      const t = e.target as Element;
      if (this.over && !t.closest("#panel, #panel-toggle, #toasts")) this.toggle();
    });
    this.refresh();
  }

  private get open(): boolean {
    return this.wide.matches ? !this.settings.panelClosed : this.over;
  }

  toggle(): void {
    if (this.wide.matches) this.settings.panelClosed = !this.settings.panelClosed;
    else this.over = !this.over;
    const hadFocus = this.panel.contains(document.activeElement);
    this.refresh();
    this.save();
    if (this.over) this.focusTab();
    else if (hadFocus && !this.open) this.toggleButton.focus();
  }

  /** Opens the panel with this tab. */
  show(tab: T["tab"]): void {
    this.choose(tab);
    if (!this.open) this.toggle();
    this.focusTab();
  }

  private focusTab(): void {
    this.panel.querySelector<HTMLElement>('[aria-selected="true"]')?.focus();
  }

  /** Arrow keys, Home and End move between the tabs. */
  private tabKey(e: KeyboardEvent): void {
    const i = this.tabs.findIndex((t) => t === document.activeElement);
    const n = this.tabs.length;
    const to = { ArrowRight: (i + 1) % n, ArrowLeft: (i + n - 1) % n, Home: 0, End: n - 1 }[e.key];
    if (i < 0 || to === undefined) return;
    e.preventDefault();
    this.choose(this.tabs[to]!.dataset.tab!);
    this.tabs[to]!.focus();
  }

  private choose(name: string): void {
    for (const t of this.tabs) {
      const on = t.dataset.tab === name;
      t.setAttribute("aria-selected", String(on));
      t.tabIndex = on ? 0 : -1;
      byId(t.getAttribute("aria-controls")!, HTMLElement).hidden = !on;
    }
    this.settings.tab = name as T["tab"];
    this.save();
  }

  private refresh(): void {
    document.body.dataset.panel = this.open ? "open" : "closed";
    document.body.dataset.over = String(this.over);
    this.panel.inert = !this.open;
    this.toggleButton.setAttribute("aria-expanded", String(this.open));
  }
}
