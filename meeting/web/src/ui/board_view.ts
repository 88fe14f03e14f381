// SPDX-License-Identifier: Apache-2.0
// The blackboard, large: to be read and drawn on with mouse, finger, pen or keys.

import { button, byId, confirmTwice, h } from "#web/shared/dom";
import { CHALKS, WIDTHS } from "../strokes";

const STEP = 0.01; // of the board's width, for a key
const MOST_WAY = 20000; // numbers of one line: then it goes on as the next

interface Uses {
  /** The picture of the board. */
  picture: HTMLCanvasElement;
  draw: (colour: string, width: number, way: readonly number[]) => boolean;
  undo: () => boolean;
  /** Gives an empty string when it is done, or the reason why not. */
  wipe: () => Promise<string>;
  announce: (words: string) => void;
  opened: (open: boolean) => void;
}

export class BoardView {
  private readonly box = byId("board", HTMLElement);
  private readonly canvas = byId("board-canvas", HTMLCanvasElement);
  private readonly g: CanvasRenderingContext2D;
  private readonly words = byId("board-words", HTMLElement);
  private readonly toggleButton: HTMLButtonElement;
  private readonly wipeButton: HTMLButtonElement;
  private mayDraw = false;
  private way: number[] = []; // of the line under way
  private pointer: number | null = null;
  private pen = { x: 0.5, y: 0.5, down: false, shown: false };
  private due = false;

  constructor(private readonly uses: Uses) {
    this.g = this.canvas.getContext("2d", { alpha: false })!;
    this.toggleButton = button("board-toggle", () => this.toggle());
    button("board-close", () => this.toggle(false));
    button("board-undo", () => this.undo());
    this.wipeButton = button(
      "board-clear",
      confirmTwice(
        (asking) => this.showWipe(asking),
        () => void this.wipe(),
      ),
    );
    this.showWipe(false);
    this.choices("chalks", "chalk", CHALKS);
    this.choices("widths", "width", WIDTHS);
    this.canvas.addEventListener("pointerdown", (e) => this.down(e));
    this.canvas.addEventListener("pointermove", (e) => this.move(e));
    for (const end of ["pointerup", "pointercancel"] as const)
      this.canvas.addEventListener(end, (e) => this.up(e));
    this.canvas.addEventListener("keydown", (e) => this.key(e));
    this.canvas.addEventListener("blur", () => this.lift());
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    this.allow(false, false);
  }

  get open(): boolean {
    return !this.box.hidden;
  }

  allow(draw: boolean, wipe: boolean): void {
    this.mayDraw = draw;
    this.wipeButton.hidden = !wipe;
    this.canvas.classList.toggle("draws", draw);
    for (const id of ["chalks", "widths", "board-undo"]) byId(id, HTMLElement).hidden = !draw;
    this.words.textContent = draw ? "" : "You can read the blackboard but not draw on it.";
  }

  toggle(open = this.box.hidden): void {
    if (open === this.open) return;
    this.lift();
    this.box.hidden = !open;
    this.toggleButton.setAttribute("aria-expanded", String(open));
    this.uses.opened(open);
    if (open) {
      this.resize();
      this.canvas.focus();
    } else {
      this.toggleButton.focus();
    }
  }

  undo(): void {
    if (!this.mayDraw) return;
    const undone = this.uses.undo();
    if (undone) this.words.textContent = "";
    this.uses.announce(undone ? "Your last line was removed." : "You have no lines to undo.");
  }

  private async wipe(): Promise<void> {
    const refused = await this.uses.wipe();
    this.words.textContent = refused;
    if (!refused) this.uses.announce("The blackboard is wiped.");
  }

  /** The picture has changed. */
  refresh(): void {
    if (this.due || !this.open) return;
    this.due = true;
    requestAnimationFrame(() => this.paint());
  }

  private choices(id: string, name: string, list: Record<string, string | number>): void {
    byId(id, HTMLElement).replaceChildren(
      ...Object.entries(list).map(([label, value], i) => {
        const radio = h("input", { type: "radio", name, value: String(value), "aria-label": label });
        radio.checked = i === 0;
        const mark = h("span", { class: `chalk ${name}` });
        if (typeof value === "string") mark.style.background = value;
        else mark.style.setProperty("--size", `${value / 9 + 2}px`);
        return h("label", { title: label }, radio, mark);
      }),
    );
  }

  private chosen(name: string): string {
    return this.box.querySelector<HTMLInputElement>(`input[name="${name}"]:checked`)!.value;
  }

  private resize(): void {
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    const w = Math.max(1, Math.round(this.canvas.clientWidth * ratio));
    if (this.canvas.width !== w) {
      this.canvas.width = w;
      this.canvas.height = Math.round(w / 2);
    }
    this.refresh();
  }

  private paint(): void {
    this.due = false;
    if (!this.open) return;
    const { width: w, height } = this.canvas;
    this.g.imageSmoothingQuality = "high";
    this.g.drawImage(this.uses.picture, 0, 0, w, height);
    this.paintLine(0);
    if (!this.pen.shown) return;
    // Where the chalk is, for those who draw by keyboard.
    this.g.strokeStyle = "#ffffff";
    this.g.lineWidth = 2;
    this.g.beginPath();
    this.g.arc(this.pen.x * w, this.pen.y * height, this.pen.down ? 6 : 12, 0, 2 * Math.PI);
    this.g.stroke();
  }

  /** The line under way, from its `from`th number on. */
  private paintLine(from: number): void {
    const { width: w, height } = this.canvas;
    const start = Math.max(0, from - 2);
    if (this.way.length - start < 2) return;
    const g = this.g;
    g.strokeStyle = this.chosen("chalk");
    g.lineWidth = Math.max(1, (Number(this.chosen("width")) / 10000) * w);
    g.lineCap = g.lineJoin = "round";
    g.beginPath();
    for (let i = start; i < this.way.length; i += 2) g.lineTo(this.way[i]! * w, this.way[i + 1]! * height);
    if (this.way.length === 2) g.lineTo(this.way[0]! * w + 0.1, this.way[1]! * height);
    g.stroke();
  }

  private at(e: PointerEvent): [number, number] {
    const box = this.canvas.getBoundingClientRect();
    const part = (v: number, size: number): number => Math.min(1, Math.max(0, v / Math.max(1, size)));
    return [part(e.clientX - box.left, box.width), part(e.clientY - box.top, box.height)];
  }

  private down(e: PointerEvent): void {
    if (e.button !== 0 || this.pointer !== null || !this.mayDraw) return;
    this.lift();
    this.pen.shown = false;
    this.canvas.setPointerCapture(e.pointerId);
    this.pointer = e.pointerId;
    this.way = this.at(e);
    this.paintLine(0);
  }

  private move(e: PointerEvent): void {
    if (e.pointerId !== this.pointer) return;
    const from = this.way.length;
    const all = e.getCoalescedEvents?.() ?? [];
    for (const c of all.length ? all : [e]) this.way.push(...this.at(c));
    this.paintLine(from);
    if (this.way.length > MOST_WAY) this.finish(true);
  }

  private up(e: PointerEvent): void {
    if (e.pointerId !== this.pointer) return;
    this.pointer = null;
    this.finish(false);
  }

  /** The line is done; `more`: it goes on where it ended. */
  private finish(more: boolean): void {
    const way = this.way;
    this.way = more ? way.slice(-2) : [];
    if (way.length < 2) return;
    const fits = this.uses.draw(this.chosen("chalk"), Number(this.chosen("width")), way);
    this.words.textContent = fits
      ? ""
      : "Your part of the blackboard is full. Undo lines, or ask a chair to wipe it.";
    this.refresh();
  }

  private key(e: KeyboardEvent): void {
    if (!this.mayDraw || e.ctrlKey || e.altKey || e.metaKey) return;
    const k = STEP * (e.shiftKey ? 5 : 1);
    const step: Record<string, [number, number]> = {
      ArrowLeft: [-k, 0],
      ArrowRight: [k, 0],
      ArrowUp: [0, -2 * k],
      ArrowDown: [0, 2 * k],
    };
    const by = step[e.key];
    if (by) {
      this.pen.x = Math.min(1, Math.max(0, this.pen.x + by[0]));
      this.pen.y = Math.min(1, Math.max(0, this.pen.y + by[1]));
      if (this.pen.down) this.way.push(this.pen.x, this.pen.y);
    } else if (e.key === " ") {
      if (this.pen.down) this.lift();
      else {
        this.pen.down = true;
        this.way = [this.pen.x, this.pen.y];
        this.uses.announce("The chalk is on the board.");
      }
    } else {
      return;
    }
    e.preventDefault();
    e.stopPropagation();
    this.pen.shown = true;
    this.refresh();
  }

  /** Ends a line that is drawn by keyboard. */
  private lift(): void {
    if (!this.pen.down) return;
    this.pen.down = false;
    this.finish(false);
    this.uses.announce("The chalk is off the board.");
  }

  /** `asking`: a second press wipes the board. */
  private showWipe(asking: boolean): void {
    this.wipeButton.classList.toggle("sure", asking);
    this.wipeButton.setAttribute(
      "aria-label",
      asking
        ? "Wipe the lines of all participants? Press again to wipe"
        : "Wipe the blackboard: the lines of all participants",
    );
    this.wipeButton.title = asking ? "Press again to wipe the blackboard" : "Wipe the blackboard";
  }
}
