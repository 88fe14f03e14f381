// SPDX-License-Identifier: Apache-2.0
// Before the room: a name, an avatar, or just watching.

import { AvatarError } from "../../avatar/inspect";
import { button, byId, h } from "../../ui/dom";
import { describeFile } from "../avatar_file";
import { EntryError, LOOKS, type Kept } from "../entry";
import { MAX_NAME, characters, type AvatarChoice } from "../messages";
import { plainLine } from "../names";
import { portrait } from "./portrait";

const SUMMARY: Record<string, string> = {
  plain: "T-shirt, short hair.",
  casual: "Hooded jumper, bob.",
  office: "Jacket and tie, short hair.",
  summer: "Sleeveless top, bun.",
  robot: "White shells over a dark frame.",
  url: "A VRM file of yours, from the web.",
  none: "Your name over an empty chair.",
};

export interface Wish {
  watch: boolean;
  name: string;
  avatar: AvatarChoice | null;
}

const lookName = (look: string): string => {
  const words = look.replace(/[-_]+/g, " ");
  return words.charAt(0).toUpperCase() + words.slice(1);
};

export class Door {
  private readonly box = byId("door", HTMLElement);
  private readonly name = byId("name", HTMLInputElement);
  private readonly url = byId("avatar-url", HTMLInputElement);
  private readonly error = byId("door-error", HTMLElement);
  private busy = false;

  /** `come`: lets the person in; throws EntryError in words. `keep`: what was chosen. */
  constructor(
    kept: Kept,
    private readonly come: (wish: Wish) => Promise<void>,
    private readonly keep: (name: string, avatar: string) => void,
  ) {
    this.name.value = plainLine(kept.name, MAX_NAME);
    const chosen = kept.avatar || `look:${LOOKS[0]}`;
    byId("looks", HTMLElement).replaceChildren(
      ...LOOKS.map((l) => this.choice(`look:${l}`, lookName(l), portrait(l), chosen === `look:${l}`)),
      this.choice("url", "My own", portrait("url"), chosen.startsWith("url:")),
      this.choice("none", "None", portrait("none"), chosen === "none"),
    );
    if (chosen.startsWith("url:")) this.url.value = chosen.slice(4);
    this.showUrl();
    byId("door-form", HTMLFormElement).addEventListener("submit", (e) => {
      e.preventDefault();
      void this.enter(false);
    });
    button("watch", () => void this.enter(true));
  }

  /** Shows the door; `words`: why one stands before it again. */
  open(words: string, canEnter: boolean): void {
    this.box.hidden = false;
    this.say(words);
    for (const id of ["enter", "watch"]) byId(id, HTMLButtonElement).disabled = !canEnter;
    if (canEnter) this.name.focus();
  }

  close(): void {
    this.box.hidden = true;
  }

  private choice(value: string, name: string, picture: SVGElement, checked: boolean): HTMLElement {
    const radio = h("input", { type: "radio", name: "look", value });
    radio.checked = checked;
    radio.addEventListener("change", () => this.showUrl());
    return h("label", { class: "look" }, radio, picture, h("span", {}, name));
  }

  private get chosen(): string {
    return this.box.querySelector<HTMLInputElement>('input[name="look"]:checked')?.value ?? "none";
  }

  private showUrl(): void {
    byId("own-avatar", HTMLElement).hidden = this.chosen !== "url";
    byId("look-note", HTMLElement).textContent = SUMMARY[this.chosen.replace(/^look:/, "")] ?? "";
  }

  private say(words: string): void {
    this.error.textContent = words;
  }

  private async enter(watch: boolean): Promise<void> {
    if (this.busy) return;
    const name = plainLine(this.name.value, 200);
    if (!watch) {
      const n = characters(name);
      this.name.setAttribute("aria-invalid", String(n < 1 || n > MAX_NAME));
      if (n < 1 || n > MAX_NAME) {
        this.say(
          n < 1
            ? "Give a name first: others see it over your head."
            : `A name has ${MAX_NAME} characters at most.`,
        );
        this.name.focus();
        return;
      }
    }
    this.wait(true);
    try {
      const avatar = watch ? null : await this.avatar();
      if (!watch) this.keep(name, this.chosen === "url" ? `url:${this.url.value.trim()}` : this.chosen);
      await this.come({ watch, name, avatar });
    } catch (e) {
      if (e instanceof AvatarError) this.url.focus();
      const known = e instanceof AvatarError || e instanceof EntryError;
      this.say(known ? e.message : "Something went wrong. Try again.");
      if (!known) console.error(e);
    } finally {
      this.wait(false);
    }
  }

  private async avatar(): Promise<AvatarChoice | null> {
    const chosen = this.chosen;
    if (chosen === "none") return null;
    if (chosen !== "url") return { look: chosen.slice(5) };
    this.say("");
    return describeFile(this.url.value);
  }

  private wait(on: boolean): void {
    this.busy = on;
    if (on) this.say("");
    this.box.setAttribute("aria-busy", String(on));
    for (const id of ["enter", "watch"]) byId(id, HTMLButtonElement).disabled = on;
  }
}
