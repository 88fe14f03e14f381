// SPDX-License-Identifier: Apache-2.0
// Names over the heads, and new messages of the chat: text over the picture, never HTML.

import type { Camera, Vector3 } from "three";
import { plainLine } from "../names";
import { h } from "#web/shared/dom";

const SAID = 7; // s that a message stays
const MOST_WORDS = 90; // characters

interface Tag {
  box: HTMLElement;
  name: HTMLElement;
  said: HTMLElement;
  until: number;
  at: string;
}

export class Tags {
  private readonly all = new Map<string, Tag>();

  constructor(private readonly layer: HTMLElement) {}

  set(id: string, name: string, note: "" | "me"): void {
    const tag = this.all.get(id) ?? this.make(id);
    if (tag.name.textContent !== name) tag.name.textContent = name;
    tag.box.dataset.note = note;
  }

  remove(id: string): void {
    this.all.get(id)?.box.remove();
    this.all.delete(id);
  }

  showMessage(id: string, text: string, now: number): void {
    const tag = this.all.get(id);
    if (!tag) return;
    tag.said.textContent = plainLine(text, MOST_WORDS);
    tag.said.hidden = false;
    tag.until = now + SAID;
  }

  private make(id: string): Tag {
    const name = h("span", { class: "tag-name", dir: "auto" });
    const said = h("span", { class: "tag-said", dir: "auto" });
    said.hidden = true;
    const box = h("div", { class: "tag" }, said, name);
    this.layer.append(box);
    const tag = { box, name, said, until: 0, at: "" };
    this.all.set(id, tag);
    return tag;
  }

  /** Hides messages whose time is over. */
  step(now: number): void {
    for (const t of this.all.values()) if (!t.said.hidden && now > t.until) t.said.hidden = true;
  }

  /** Puts the tag where `point` (of the world) is in the picture; null: it is hidden. */
  place(id: string, point: Vector3 | null, camera: Camera): void {
    const tag = this.all.get(id);
    if (!tag) return;
    const p = point?.project(camera);
    if (!p || p.z > 1 || Math.abs(p.x) > 1.1 || Math.abs(p.y) > 1.1) {
      if (tag.at !== "") tag.box.classList.remove("shown");
      tag.at = "";
      return;
    }
    const x = ((p.x + 1) / 2) * this.layer.clientWidth;
    const y = ((1 - p.y) / 2) * this.layer.clientHeight;
    const at = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
    if (at === tag.at) return;
    if (tag.at === "") tag.box.classList.add("shown");
    tag.at = at;
    tag.box.style.transform = at;
    tag.box.style.zIndex = String(Math.round((1 - p.z) * 1e5));
  }
}
