// SPDX-License-Identifier: Apache-2.0
// For tests: as much of a document as the parts of the page touch. An element exists as soon as its id is used.

import { afterEach, beforeEach, vi } from "vitest";

type Child = FakeElement | string;

export class FakeElement {
  readonly dataset: Record<string, string> = {};
  readonly classes = new Set<string>();
  readonly classList = {
    toggle: (name: string, on: boolean) => void (on ? this.classes.add(name) : this.classes.delete(name)),
  };
  readonly style = { width: "", background: "", setProperty: () => {} };
  hidden = true;
  disabled = false;
  checked = false;
  value = "";
  private nodes: Child[] = [];
  private parent: FakeElement | null = null;
  private readonly attributes = new Map<string, string>();
  private readonly listeners = new Map<string, (e: unknown) => void>();

  get children(): FakeElement[] {
    return this.nodes.filter((n) => typeof n !== "string");
  }
  get firstChild(): Child | null {
    return this.nodes[0] ?? null;
  }
  get textContent(): string {
    return this.nodes.map((n) => (typeof n === "string" ? n : n.textContent)).join("");
  }
  set textContent(words: string) {
    this.nodes = words ? [words] : [];
  }
  prepend(...nodes: Child[]): void {
    this.hold([...nodes, ...this.nodes]);
  }
  append(...nodes: Child[]): void {
    this.hold([...this.nodes, ...nodes]);
  }
  replaceChildren(...nodes: Child[]): void {
    this.hold(nodes);
  }
  private hold(nodes: Child[]): void {
    this.nodes = nodes;
    for (const c of this.children) c.parent = this;
  }
  remove(): void {
    this.parent?.hold(this.parent.nodes.filter((n) => n !== this));
  }
  contains(e: unknown): boolean {
    return e === this || this.children.some((c) => c.contains(e));
  }
  setAttribute(name: string, value: string): void {
    this.attributes.set(name, value);
  }
  getAttribute(name: string): string | null {
    return this.attributes.get(name) ?? null;
  }
  removeAttribute(name: string): void {
    this.attributes.delete(name);
  }
  /** Knows `[name]` and `[name="value"]` alone. */
  querySelectorAll(selector: string): FakeElement[] {
    const [name, value] = selector.slice(1, -1).replaceAll('"', "").split("=") as [string, string?];
    const fits = ({ attributes }: FakeElement): boolean =>
      value === undefined ? attributes.has(name) : attributes.get(name) === value;
    return this.children.flatMap((c) => [...(fits(c) ? [c] : []), ...c.querySelectorAll(selector)]);
  }
  querySelector(selector: string): FakeElement | null {
    return this.querySelectorAll(selector)[0] ?? null;
  }
  focus(): void {
    Object.assign(document, { activeElement: this });
  }
  getClientRects(): object[] {
    return this.hidden ? [] : [{}];
  }

  addEventListener(type: string, then: (e: unknown) => void): void {
    this.listeners.set(type, then);
  }
  dispatch(type: string): void {
    this.listeners.get(type)?.({ preventDefault: () => {} });
  }
  press(): void {
    this.dispatch("click");
  }
}

/**
 * Gives each test of a file fake timers and a new document in place of the browser's. Returns a function that gives the
 * element of an id.
 */
export function useFakePage(): (id: string) => FakeElement {
  let element!: (id: string) => FakeElement;
  beforeEach(() => {
    vi.useFakeTimers();
    element = fakeDocument();
  });
  afterEach(() => {
    vi.clearAllTimers();
    vi.useRealTimers();
    vi.unstubAllGlobals();
  });
  return (id) => element(id);
}

function fakeDocument(): (id: string) => FakeElement {
  const elements = new Map<string, FakeElement>();
  const element = (id: string): FakeElement => {
    const known = elements.get(id) ?? new FakeElement();
    elements.set(id, known);
    return known;
  };
  vi.stubGlobal("window", globalThis);
  vi.stubGlobal("addEventListener", () => {});
  for (const kind of ["", "Button", "Input", "Form", "Canvas", "Dialog"])
    vi.stubGlobal(`HTML${kind}Element`, FakeElement);
  vi.stubGlobal("document", {
    activeElement: null,
    hidden: false,
    body: new FakeElement(),
    documentElement: new FakeElement(),
    addEventListener: () => {},
    getElementById: element,
    createElement: () => new FakeElement(),
    createElementNS: () => new FakeElement(),
    querySelectorAll: () => [],
  });
  return element;
}
