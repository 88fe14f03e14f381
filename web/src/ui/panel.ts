// SPDX-License-Identifier: Apache-2.0
// The side panel: always there on a wide page, over the page on a narrow one.

import { button, byId } from "./dom";
import { Tabs } from "./tabs";

/** What is kept of a panel. */
export interface PanelSettings {
  panelClosed: boolean; // on a wide page
  tab: string;
}

export class Panel<T extends PanelSettings> {
  private readonly panel = byId("panel", HTMLElement);
  private readonly toggleButton: HTMLButtonElement;
  private readonly tabs: Tabs;
  private readonly wide = window.matchMedia("(min-width: 1200px)");
  private over = false; // opened over the page

  constructor(
    private readonly settings: T,
    private readonly keep: () => void,
  ) {
    this.tabs = new Tabs(this.panel.querySelector<HTMLElement>('[role="tablist"]')!, (name) => {
      this.settings.tab = name as T["tab"];
      this.keep();
    });
    this.tabs.choose(settings.tab);
    this.toggleButton = button("panel-toggle", () => this.toggle());
    button("panel-close", () => this.toggle());
    this.wide.addEventListener("change", () => {
      this.over = false;
      this.refresh();
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
    if (this.wide.matches) {
      this.settings.panelClosed = !this.settings.panelClosed;
      this.keep();
    } else {
      this.over = !this.over;
    }
    const had = this.panel.contains(document.activeElement);
    this.refresh();
    if (this.over) this.panel.querySelector<HTMLElement>('[aria-selected="true"]')?.focus();
    else if (had && !this.open) this.toggleButton.focus();
  }

  show(tab: T["tab"]): void {
    this.tabs.choose(tab);
    if (!this.open) this.toggle();
    this.panel.querySelector<HTMLElement>('[aria-selected="true"]')?.focus();
  }

  private refresh(): void {
    document.body.dataset.panel = this.open ? "open" : "closed";
    document.body.dataset.over = String(this.over);
    this.panel.inert = !this.open;
    this.toggleButton.setAttribute("aria-expanded", String(this.open));
  }
}
