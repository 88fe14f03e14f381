// SPDX-License-Identifier: Apache-2.0
// Helpers for the document.

/** An element with attributes, listeners such as `onclick`, and children; text is set as text, never as HTML. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Record<string, string | (() => void)> = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const e = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "string") e.setAttribute(name, value);
    else e.addEventListener(name.slice(2), value);
  }
  e.append(...children);
  return e;
}

/** The element with this id; throws when the page has none of this kind. */
export function byId<T extends Element>(id: string, kind: { new (): T }): T {
  const e = document.getElementById(id);
  if (!(e instanceof kind)) throw new Error(`the page has no ${id}`);
  return e;
}

/** The button with this id; `pressed` runs on each click. */
export function button(id: string, pressed: () => void): HTMLButtonElement {
  const b = byId(id, HTMLButtonElement);
  b.addEventListener("click", pressed);
  return b;
}

const CONFIRM_TIME = 4000; // ms

/** A listener for a button that acts on a second press soon after the first; `show`: whether it asks for that press. */
export function confirmTwice(show: (asking: boolean) => void, act: () => void): () => void {
  let timer = 0;
  const ask = (on: boolean): void => {
    window.clearTimeout(timer);
    timer = on ? window.setTimeout(() => ask(false), CONFIRM_TIME) : 0;
    show(on);
  };
  return () => {
    const confirmed = timer > 0;
    ask(!confirmed);
    if (confirmed) act();
  };
}

/** Sets the text only when it differs: screen readers do not read it again. */
export function setText(e: Element, text: string): void {
  if (e.textContent !== text) e.textContent = text;
}

/** Shows a count at the label of a tab (frame.ts), nothing for 0. `bad`: with a mark that something is wrong. */
export function setCount(tab: string, count: number, bad = false): void {
  const label = byId(`count-${tab}`, HTMLElement);
  setText(label, count ? `${count}${bad ? " !" : ""}` : "");
  label.classList.toggle("bad", bad);
}

/** Replaces the children only when `key` has changed. The element with the focus keeps it, by its data-focus. */
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

/** "plain-look" as a label: "Plain look". */
export function labelOf(name: string): string {
  const words = name.replace(/[-_]+/g, " ");
  return words.charAt(0).toUpperCase() + words.slice(1);
}

/** A size for people: "12 B", "81 kB", "4.5 MB". */
export function sizeText(bytes: number): string {
  if (bytes < 1000) return `${bytes} B`;
  if (bytes < 1e6) return `${Math.round(bytes / 1e3)} kB`;
  return `${(bytes / 1e6).toFixed(bytes < 1e7 ? 1 : 0)} MB`;
}

/** A duration as minutes and seconds: "1:01". */
export function durationText(seconds: number): string {
  const s = Math.max(0, Math.floor(seconds));
  return `${Math.floor(s / 60)}:${String(s % 60).padStart(2, "0")}`;
}
