// SPDX-License-Identifier: Apache-2.0
// The choice of the avatar: one of the program's, or a file of the user that is chosen or dropped on the page.

import { fromProgram } from "../avatar/fetch";
import { AvatarError, checkSize } from "../avatar/inspect";
import type { Avatar } from "../avatar/load";
import { getAvatar, listAvatars, putAvatar, removeAvatar, type StoredEntry } from "../avatar/store";
import { button, byId, h, labelOf, sizeText } from "../shared/dom";
import { trashButton } from "../shared/icons";
import type { Level } from "../shared/notices";

export interface AvatarInfo {
  id: string; // as in the settings
  name: string;
  version: "0" | "1";
  author: string;
}

interface Uses {
  load: (data: ArrayBuffer) => Promise<Avatar>;
  show: (avatar: Avatar) => void;
  notify: (level: Level, words: string) => void;
  remember: (id: string) => void;
}

const NONE = "No avatar is shown.";
const STAYS = "The avatar stays as it was.";

/** An avatar that was requested and has neither arrived nor failed. */
interface Request {
  id: string;
  remember: boolean;
}

export class Avatars {
  info: AvatarInfo | null = null;
  private looks: string[] = [];
  private own: StoredEntry[] = [];
  private wanted = "";
  /** The last request, also while a file has taken precedence over it. */
  private request: Request | null = null;
  private turn = 0;
  /** The program has sent its list. */
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
    this.acceptDrops();
    this.list();
  }

  /** Takes the list of the program, and shows the avatar of the settings or else the first one. */
  async setLooks(looks: readonly string[]): Promise<void> {
    this.looks = [...looks];
    this.own = await listAvatars();
    this.ready = true;
    this.list();
    if (!this.info && !this.wanted) await this.start({ id: this.preferred, remember: false });
  }

  /** Shows the requested one, or else the program's first one when nothing is shown. */
  private async start(request: Request): Promise<void> {
    const first = this.looks[0] ? `look:${this.looks[0]}` : "";
    if (this.ids().includes(request.id)) {
      const turn = this.turn + 1;
      const another = !this.info && first !== "" && first !== request.id;
      if (await this.load(request, !another)) return;
      if (turn !== this.turn || !another) return; // or the user has chosen another one
    }
    // A substitute is not remembered: the next visit tries the user's choice again.
    if (first && !this.info) await this.load({ id: first, remember: false }, true);
  }

  /** Shows it, now and on the next visit. True when it is shown; otherwise the old one stays. */
  choose(id: string): Promise<boolean> {
    return this.load({ id, remember: true }, true);
  }

  /** `last`: when it cannot be shown, no other is tried. */
  private async load(request: Request, last: boolean): Promise<boolean> {
    const { id, remember } = request;
    const turn = ++this.turn;
    this.request = request;
    this.wanted = id;
    this.list();
    try {
      const got = id.startsWith("own:") ? await this.fromStore(id.slice(4)) : await fromProgram(id.slice(5));
      if (turn !== this.turn) return false; // another one has been chosen
      const shown = await this.put(id, got.name, got.data, turn);
      if (shown && remember) this.uses.remember(id);
      return shown;
    } catch (e) {
      if (turn !== this.turn) return false;
      this.request = null;
      this.failed(e, "The avatar could not be loaded", last);
      return false;
    } finally {
      if (turn === this.turn) this.wanted = "";
      this.list();
    }
  }

  /** Shows a file of the user. A file that can be shown is stored for the next visit. */
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
        } // else another one has been chosen
      } catch {
        this.uses.notify(
          "warning",
          "The avatar is shown, but this browser has no space to store it for the next visit.",
        );
      }
      this.own = await listAvatars();
      return true;
    } catch (e) {
      if (turn !== this.turn) return false;
      // Continue with what the file took precedence over: a request, or the start when the list has not arrived.
      const { request } = this;
      const continues = request !== null || (!this.info && (!this.ready || this.ids().length > 0));
      this.failed(e, `${file.name} could not be read`, !continues);
      this.wanted = "";
      this.request = null;
      if (continues && this.ready) await this.start(request ?? { id: this.preferred, remember: false });
      return false;
    } finally {
      if (turn === this.turn) this.wanted = "";
      this.list();
    }
  }

  private ids(): string[] {
    return [...this.looks.map((l) => `look:${l}`), ...this.own.map((o) => `own:${o.id}`)];
  }

  private async fromStore(id: string): Promise<{ name: string; data: ArrayBuffer }> {
    const kept = await getAvatar(id);
    if (!kept) throw new AvatarError("This avatar is no longer stored in this browser. Load the file again.");
    return kept;
  }

  private async put(id: string, name: string, data: ArrayBuffer, turn: number): Promise<boolean> {
    const avatar = await this.uses.load(data);
    if (turn !== this.turn) {
      avatar.dispose();
      return false;
    }
    this.request = null;
    this.info = { id, name, version: avatar.facts.version, author: avatar.facts.author };
    this.uses.show(avatar);
    if (avatar.notes.length > 0) this.uses.notify("info", `${name}: ${avatar.notes.join("; ")}.`);
    return true;
  }

  /** `last`: nothing else is tried, so the message adds what is shown. */
  private failed(e: unknown, otherwise: string, last: boolean): void {
    const words = e instanceof AvatarError ? e.message : `${otherwise}. Try again.`;
    this.uses.notify("error", last ? `${words} ${this.info ? STAYS : NONE}` : words);
  }

  private list(): void {
    const box = byId("avatars", HTMLElement);
    const focus = box.contains(document.activeElement)
      ? (document.activeElement as HTMLElement).dataset.id
      : undefined;
    const rows = [
      ...this.looks.map((l) => this.row(`look:${l}`, labelOf(l), "From Telemime", null)),
      ...this.own.map((o) => this.row(`own:${o.id}`, o.name, `Your file, ${sizeText(o.bytes)}`, o.id)),
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
    const onchange = () => void this.choose(id);
    const radio = h("input", { type: "radio", name: "avatar", "data-id": id, onchange });
    radio.checked = this.wanted ? this.wanted === id : shown;
    const author = shown && this.info?.author ? ` · by ${this.info.author}` : "";
    const kind = shown && this.info ? ` · VRM ${this.info.version === "1" ? "1.0" : "0.x"}` : "";
    const label = h(
      "label",
      { class: "choice" },
      radio,
      h("span", { class: "row-text" }, h("b", {}, name), h("span", { class: "soft" }, note + kind + author)),
    );
    if (!own) return h("div", { class: "row" }, label);
    const remove = () => void this.remove(own);
    return h(
      "div",
      { class: "row" },
      label,
      trashButton(`Remove ${name}`, remove, { "data-id": `remove ${id}` }),
    );
  }

  private async remove(id: string): Promise<void> {
    await removeAvatar(id).catch(() => undefined);
    this.own = await listAvatars();
    if (this.info?.id === `own:${id}` && this.looks[0]) await this.choose(`look:${this.looks[0]}`);
    this.list();
  }

  private acceptDrops(): void {
    const hint = byId("drop", HTMLElement);
    const files = (e: DragEvent) => e.dataTransfer?.types.includes("Files") ?? false;
    window.addEventListener("dragover", (e) => {
      if (!files(e)) return;
      e.preventDefault();
      hint.hidden = false;
    });
    window.addEventListener("dragleave", (e) => {
      if (!e.relatedTarget) hint.hidden = true; // it has left the window
    });
    window.addEventListener("drop", (e) => {
      if (!files(e)) return;
      e.preventDefault();
      hint.hidden = true;
      const f = e.dataTransfer?.files[0];
      if (f) void this.take(f);
    });
  }
}
