// SPDX-License-Identifier: Apache-2.0

export type Child = Node | string | null;

/** An element with attributes and children; text is set as text, never as HTML. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Record<string, string> = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const e = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) e.setAttribute(name, value);
  for (const c of children) if (c !== null) e.append(c);
  return e;
}

/** An icon of the sheet in the page. */
export function icon(name: string): SVGSVGElement {
  const ns = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(ns, "svg");
  svg.setAttribute("class", "icon");
  svg.setAttribute("aria-hidden", "true");
  const use = document.createElementNS(ns, "use");
  use.setAttribute("href", `#i-${name}`);
  svg.append(use);
  return svg;
}

/** The element that the page must have. */
export function byId<T extends Element>(id: string, kind: { new (): T }): T {
  const e = document.getElementById(id);
  if (!(e instanceof kind)) throw new Error(`the page has no ${id}`);
  return e;
}

export function button(id: string, pressed: () => void): HTMLButtonElement {
  const b = byId(id, HTMLButtonElement);
  b.addEventListener("click", pressed);
  return b;
}

/** Replaces the children only when `key` is new: what has the focus keeps it. */
export function renderOnce(parent: HTMLElement, key: string, make: () => Node[]): void {
  if (parent.dataset.key === key) return;
  parent.dataset.key = key;
  const focus = parent.contains(document.activeElement) ? document.activeElement : null;
  const name = focus?.getAttribute("data-focus");
  parent.replaceChildren(...make());
  if (!name) return;
  const again = parent.querySelector<HTMLElement>(`[data-focus="${CSS.escape(name)}"]`);
  (again ?? parent.closest<HTMLElement>("[tabindex]"))?.focus();
}

export function megabytes(bytes: number): string {
  if (bytes < 1000) return `${bytes} B`;
  if (bytes < 1e6) return `${Math.round(bytes / 1e3)} kB`;
  return `${(bytes / 1e6).toFixed(bytes < 1e7 ? 1 : 0)} MB`;
}

export function clock(seconds: number): string {
  const s = Math.max(0, Math.floor(seconds));
  return `${Math.floor(s / 60)}:${String(s % 60).padStart(2, "0")}`;
}
