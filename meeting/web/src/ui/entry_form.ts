// SPDX-License-Identifier: Apache-2.0
// The form before the meeting: a name and an avatar, or watching only.

import { AvatarError } from "#web/avatar/inspect";
import { button, byId, h, labelOf } from "#web/shared/dom";
import { describeFile } from "../avatar_file";
import { EntryError, LOOKS, type Saved } from "../entry";
import { MAX_NAME, characters, type AvatarChoice } from "../messages";
import { plainLine } from "../names";
import { portrait } from "./portrait";

const SUMMARY: Record<string, string> = {
  plain: "T-shirt, short hair.",
  casual: "Hooded jumper, bob.",
  office: "Jacket and tie, short hair.",
  summer: "Sleeveless top, bun.",
  robot: "White shells over a dark frame.",
  url: "A VRM file from the web.",
  none: "Your name above an empty chair.",
};

export interface Wish {
  watch: boolean;
  name: string;
  avatar: AvatarChoice | null;
}

export class EntryForm {
  private readonly box = byId("entry", HTMLElement);
  private readonly name = byId("name", HTMLInputElement);
  private readonly url = byId("avatar-url", HTMLInputElement);
  private readonly error = byId("entry-error", HTMLElement);
  private busy = false;

  /** `come` joins the meeting, or throws EntryError. `keep` stores the choices. */
  constructor(
    saved: Saved,
    private readonly come: (wish: Wish) => Promise<void>,
    private readonly keep: (name: string, avatar: string) => void,
  ) {
    this.name.value = plainLine(saved.name, MAX_NAME);
    const chosen = saved.avatar || `look:${LOOKS[0]}`;
    byId("looks", HTMLElement).replaceChildren(
      ...LOOKS.map((l) => this.choice(`look:${l}`, labelOf(l), portrait(l), chosen === `look:${l}`)),
      this.choice("url", "My own", portrait("url"), chosen.startsWith("url:")),
      this.choice("none", "None", portrait("none"), chosen === "none"),
    );
    if (chosen.startsWith("url:")) this.url.value = chosen.slice(4);
    this.showUrl();
    byId("entry-form", HTMLFormElement).addEventListener("submit", (e) => {
      e.preventDefault();
      void this.enter(false);
    });
    button("watch", () => void this.enter(true));
  }

  /** Shows the form; `words`: the reason, or empty. */
  open(words: string, canEnter: boolean): void {
    this.box.hidden = false;
    this.report(words);
    for (const id of ["enter", "watch"]) byId(id, HTMLButtonElement).disabled = !canEnter;
    if (canEnter) this.name.focus();
  }

  close(): void {
    this.box.hidden = true;
  }

  private choice(value: string, name: string, picture: SVGElement, checked: boolean): HTMLElement {
    const radio = h("input", { type: "radio", name: "look", value, onchange: () => this.showUrl() });
    radio.checked = checked;
    return h("label", { class: "look" }, radio, picture, h("span", {}, name));
  }

  private get chosen(): string {
    return this.box.querySelector<HTMLInputElement>('input[name="look"]:checked')?.value ?? "none";
  }

  private showUrl(): void {
    byId("own-avatar", HTMLElement).hidden = this.chosen !== "url";
    byId("look-note", HTMLElement).textContent = SUMMARY[this.chosen.replace(/^look:/, "")] ?? "";
  }

  private report(words: string): void {
    this.error.textContent = words;
  }

  private async enter(watch: boolean): Promise<void> {
    if (this.busy) return;
    const name = plainLine(this.name.value, 200);
    if (!watch) {
      const n = characters(name);
      this.name.setAttribute("aria-invalid", String(n < 1 || n > MAX_NAME));
      if (n < 1 || n > MAX_NAME) {
        this.report(
          n < 1
            ? "Enter a name first. Others see it above your avatar."
            : `A name has at most ${MAX_NAME} characters.`,
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
      this.report(known ? e.message : "Something went wrong. Try again.");
      if (!known) console.error(e);
    } finally {
      this.wait(false);
    }
  }

  private async avatar(): Promise<AvatarChoice | null> {
    const chosen = this.chosen;
    if (chosen === "none") return null;
    if (chosen !== "url") return { look: chosen.slice(5) };
    this.report("");
    return describeFile(this.url.value);
  }

  private wait(on: boolean): void {
    this.busy = on;
    if (on) this.report("");
    this.box.setAttribute("aria-busy", String(on));
    for (const id of ["enter", "watch"]) byId(id, HTMLButtonElement).disabled = on;
  }
}
