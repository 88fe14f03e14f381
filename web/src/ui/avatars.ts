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

const lookName = (look: string): string => {
  const words = look.replace(/[-_]+/g, " ");
  return words.charAt(0).toUpperCase() + words.slice(1);
};

export class Avatars {
  info: AvatarInfo | null = null;
  private looks: string[] = [];
  private own: StoredEntry[] = [];
  private wanted = "";
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
    if (this.info || this.wanted) return;
    const first = this.looks[0] ? `look:${this.looks[0]}` : "";
    if (this.ids().includes(this.preferred) && this.preferred !== first) {
      const turn = this.turn + 1;
      // A stand-in is not what the user chose: the next time the choice is tried again.
      if (await this.bring(this.preferred, false, first ? "Another is shown." : NONE)) return;
      if (turn !== this.turn) return; // the user chose another meanwhile
    }
    if (first) await this.bring(first, false, NONE);
  }

  /** Shows it, and again the next time. True when it is shown; the old one stays when it cannot be. */
  choose(id: string): Promise<boolean> {
    return this.bring(id, true, NONE);
  }

  /** `instead`: what is shown when it cannot be and nothing was before, in words. */
  private async bring(id: string, remember: boolean, instead: string): Promise<boolean> {
    const turn = ++this.turn;
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
      if (turn === this.turn) this.failed(e, "The avatar could not be loaded", instead);
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
      if (turn === this.turn) this.failed(e, `${file.name} could not be read`, NONE);
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
    this.info = { id, name, version: avatar.facts.version, author: avatar.facts.author };
    this.uses.show(avatar);
    return true;
  }

  private failed(e: unknown, otherwise: string, instead: string): void {
    const words = e instanceof AvatarError ? e.message : `${otherwise}. Try again.`;
    this.uses.say("error", `${words} ${this.info ? "The avatar stays as it was." : instead}`);
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
