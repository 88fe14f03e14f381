// SPDX-License-Identifier: Apache-2.0
// Which avatar is shown: the program's own looks, or a file of the user's, chosen or dropped on the page.

import { AvatarError, checkSize } from "../avatar/inspect";
import type { Avatar } from "../avatar/load";
import { getAvatar, listAvatars, putAvatar, removeAvatar, type StoredEntry } from "../avatar/store";
import { drawsInSoftware } from "../graphics";
import { button, byId, h, icon, megabytes } from "./dom";

export interface AvatarInfo {
  id: string; // as in the settings
  name: string;
  version: "0" | "1";
  author: string;
}

interface Uses {
  load: (data: ArrayBuffer) => Promise<Avatar>;
  show: (avatar: Avatar) => void;
  say: (level: "info" | "warning" | "error", words: string) => void;
  remember: (id: string) => void;
}

const NONE = "No avatar is shown.";
const STAYS = "The avatar stays as it was.";

/** An avatar that was asked for, and neither came nor failed. */
interface Wish {
  id: string;
  remember: boolean;
}

const lookName = (look: string): string => {
  const words = look.replace(/[-_]+/g, " ");
  return words.charAt(0).toUpperCase() + words.slice(1);
};

export class Avatars {
  info: AvatarInfo | null = null;
  private looks: string[] = [];
  private own: StoredEntry[] = [];
  private wanted = "";
  /** The last one, also while a file has come before it. */
  private wish: Wish | null = null;
  private turn = 0;
  /** The program has said what it has. */
  private ready = false;

  constructor(
    private readonly uses: Uses,
    private readonly preferred: string,
  ) {
    const file = byId("avatar-file", HTMLInputElement);
    file.addEventListener("change", () => {
      const f = file.files?.[0];
      file.value = "";
      if (f) void this.take(f);
    });
    button("avatar-load", () => file.click());
    this.dropping();
    this.list();
  }

  /** The program said what it has. Shows the avatar of the settings, or else the first look. */
  async setLooks(looks: readonly string[]): Promise<void> {
    this.looks = [...looks];
    this.own = await listAvatars();
    this.ready = true;
    this.list();
    if (!this.info && !this.wanted) await this.start({ id: this.preferred, remember: false });
  }

  /** Shows that one, or else the program's first look when nothing is shown. */
  private async start(wish: Wish): Promise<void> {
    const first = this.looks[0] ? `look:${this.looks[0]}` : "";
    if (this.ids().includes(wish.id)) {
      const turn = this.turn + 1;
      const another = !this.info && first !== "" && first !== wish.id;
      if (await this.bring(wish, !another)) return;
      if (turn !== this.turn || !another) return; // or the user chose another meanwhile
    }
    // A stand-in is not what the user chose: the next time the choice is tried again.
    if (first && !this.info) await this.bring({ id: first, remember: false }, true);
  }

  /** Shows it, and again the next time. True when it is shown; the old one stays when it cannot be. */
  choose(id: string): Promise<boolean> {
    return this.bring({ id, remember: true }, true);
  }

  /** `last`: when it cannot be shown, no other is tried. */
  private async bring(wish: Wish, last: boolean): Promise<boolean> {
    const { id, remember } = wish;
    const turn = ++this.turn;
    this.wish = wish;
    this.wanted = id;
    this.list();
    try {
      const got = id.startsWith("own:")
        ? await this.fromStore(id.slice(4))
        : await this.fromProgram(id.slice(5));
      if (turn !== this.turn) return false; // another was chosen meanwhile
      const shown = await this.put(id, got.name, got.data, turn);
      if (shown && remember) this.uses.remember(id);
      return shown;
    } catch (e) {
      if (turn !== this.turn) return false;
      this.wish = null;
      this.failed(e, "The avatar could not be loaded", last);
      return false;
    } finally {
      if (turn === this.turn) this.wanted = "";
      this.list();
    }
  }

  /** A file from the user. Kept for the next time when it could be shown. */
  async take(file: File): Promise<boolean> {
    const turn = ++this.turn;
    this.wanted = "file";
    this.list();
    try {
      checkSize(file.size);
      const data = await file.arrayBuffer();
      const name = file.name.replace(/\.vrm$/i, "").slice(0, 60) || "Avatar";
      if (!(await this.put("", name, data, turn))) return false;
      const info = this.info;
      try {
        const id = `own:${(await putAvatar(name, data)).id}`;
        if (info && info === this.info) {
          info.id = id;
          this.uses.remember(id);
        } // else another was chosen meanwhile
      } catch {
        this.uses.say(
          "warning",
          "The avatar is shown, but this browser has no room to keep it for the next time.",
        );
      }
      this.own = await listAvatars();
      return true;
    } catch (e) {
      if (turn !== this.turn) return false;
      // On with what this file came before: an avatar, or all when the program has yet to say what it has.
      const { wish } = this;
      const goesOn = wish !== null || (!this.info && (!this.ready || this.ids().length > 0));
      this.failed(e, `${file.name} could not be read`, !goesOn);
      this.wanted = "";
      this.wish = null;
      if (goesOn && this.ready) await this.start(wish ?? { id: this.preferred, remember: false });
      return false;
    } finally {
      if (turn === this.turn) this.wanted = "";
      this.list();
    }
  }

  private ids(): string[] {
    return [...this.looks.map((l) => `look:${l}`), ...this.own.map((o) => `own:${o.id}`)];
  }

  private async fromProgram(look: string): Promise<{ name: string; data: ArrayBuffer }> {
    const light = drawsInSoftware() ? "-light" : "";
    const answer = await fetch(`/avatars/${encodeURIComponent(look + light)}.vrm`);
    if (!answer.ok) throw new AvatarError(`Telemime does not have the avatar "${lookName(look)}".`);
    return { name: lookName(look), data: await answer.arrayBuffer() };
  }

  private async fromStore(id: string): Promise<{ name: string; data: ArrayBuffer }> {
    const kept = await getAvatar(id);
    if (!kept) throw new AvatarError("This browser no longer has that avatar. Load the file again.");
    return kept;
  }

  private async put(id: string, name: string, data: ArrayBuffer, turn: number): Promise<boolean> {
    const avatar = await this.uses.load(data);
    if (turn !== this.turn) {
      avatar.dispose();
      return false;
    }
    this.wish = null;
    this.info = { id, name, version: avatar.facts.version, author: avatar.facts.author };
    this.uses.show(avatar);
    return true;
  }

  /** `last`: nothing else is tried, so that it is known what is shown. */
  private failed(e: unknown, otherwise: string, last: boolean): void {
    const words = e instanceof AvatarError ? e.message : `${otherwise}. Try again.`;
    this.uses.say("error", last ? `${words} ${this.info ? STAYS : NONE}` : words);
  }

  private list(): void {
    const box = byId("avatars", HTMLElement);
    const focus = box.contains(document.activeElement)
      ? (document.activeElement as HTMLElement).dataset.id
      : undefined;
    const rows = [
      ...this.looks.map((l) => this.row(`look:${l}`, lookName(l), "Comes with Telemime", null)),
      ...this.own.map((o) => this.row(`own:${o.id}`, o.name, `Your file, ${megabytes(o.bytes)}`, o.id)),
    ];
    box.replaceChildren(...rows);
    box.setAttribute("aria-busy", String(Boolean(this.wanted)));
    byId("avatar-view", HTMLElement).classList.toggle("loading", Boolean(this.wanted));
    byId("avatar-none", HTMLElement).hidden = !this.ready || Boolean(this.info) || Boolean(this.wanted);
    if (!focus) return;
    const again = box.querySelector<HTMLElement>(`[data-id="${CSS.escape(focus)}"]`);
    (again ?? box.querySelector<HTMLElement>("input:checked") ?? box.querySelector("input"))?.focus();
  }

  private row(id: string, name: string, note: string, own: string | null): HTMLElement {
    const shown = this.info?.id === id;
    const radio = h("input", { type: "radio", name: "avatar", "data-id": id });
    radio.checked = this.wanted ? this.wanted === id : shown;
    radio.addEventListener("change", () => void this.choose(id));
    const author = shown && this.info?.author ? ` · by ${this.info.author}` : "";
    const kind = shown && this.info ? ` · VRM ${this.info.version === "1" ? "1.0" : "0.x"}` : "";
    const label = h(
      "label",
      { class: "choice" },
      radio,
      h("span", { class: "row-text" }, h("b", {}, name), h("span", { class: "soft" }, note + kind + author)),
    );
    if (!own) return h("div", { class: "row" }, label);
    const remove = h(
      "button",
      { class: "icon-button", "aria-label": `Forget ${name}`, title: "Forget", "data-id": `forget ${id}` },
      icon("trash"),
    );
    remove.addEventListener("click", () => void this.forget(own));
    return h("div", { class: "row" }, label, remove);
  }

  private async forget(id: string): Promise<void> {
    await removeAvatar(id).catch(() => undefined);
    this.own = await listAvatars();
    if (this.info?.id === `own:${id}` && this.looks[0]) await this.choose(`look:${this.looks[0]}`);
    this.list();
  }

  private dropping(): void {
    const hint = byId("drop", HTMLElement);
    let depth = 0;
    const files = (e: DragEvent) => e.dataTransfer?.types.includes("Files") ?? false;
    window.addEventListener("dragenter", (e) => {
      if (!files(e)) return;
      depth++;
      hint.hidden = false;
    });
    window.addEventListener("dragleave", (e) => {
      if (!files(e)) return;
      depth = Math.max(0, depth - 1);
      hint.hidden = depth === 0;
    });
    window.addEventListener("dragover", (e) => {
      if (files(e)) e.preventDefault();
    });
    window.addEventListener("drop", (e) => {
      if (!files(e)) return;
      e.preventDefault();
      depth = 0;
      hint.hidden = true;
      const f = e.dataTransfer?.files[0];
      if (f) void this.take(f);
    });
  }
}
