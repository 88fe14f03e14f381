// SPDX-License-Identifier: Apache-2.0

/** Tabs by the usual keys: arrows, Home, End move between them. */
export class Tabs {
  private readonly tabs: HTMLElement[];

  constructor(
    list: HTMLElement,
    private readonly chosen: (name: string) => void,
  ) {
    this.tabs = [...list.querySelectorAll<HTMLElement>('[role="tab"]')];
    list.addEventListener("keydown", (e) => {
      const i = this.tabs.findIndex((t) => t === document.activeElement);
      const n = this.tabs.length;
      const to = { ArrowRight: (i + 1) % n, ArrowLeft: (i + n - 1) % n, Home: 0, End: n - 1 }[e.key];
      if (i < 0 || to === undefined) return;
      e.preventDefault();
      this.choose(this.tabs[to]!.dataset.tab!);
      this.tabs[to]!.focus();
    });
    for (const t of this.tabs) t.addEventListener("click", () => this.choose(t.dataset.tab!));
  }

  choose(name: string): void {
    for (const t of this.tabs) {
      const on = t.dataset.tab === name;
      t.setAttribute("aria-selected", String(on));
      t.tabIndex = on ? 0 : -1;
      const page = document.getElementById(t.getAttribute("aria-controls") ?? "");
      if (page) page.hidden = !on;
    }
    this.chosen(name);
  }
}
