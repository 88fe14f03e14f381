// SPDX-License-Identifier: Apache-2.0
// The participants, and how their motion arrives.

import { byId, h, setCount, setText } from "#web/shared/dom";
import { qualityText, type Reading } from "../stream";

export interface PersonRow {
  id: string;
  name: string;
  me: boolean;
  chair: boolean;
  tracker: boolean;
  reading: Reading;
  /** JSON messages that were refused. */
  refused: number;
  /** The reason why the avatar is not shown, or empty. */
  complaint: string;
}

function makeRow() {
  const dot = h("span", { class: "dot" });
  const name = h("b", { dir: "auto" });
  const badges = h("span", { class: "badges" });
  const words = h("span", { class: "soft numbers" });
  const details = h("span", { class: "soft numbers" });
  const complaint = h("span", { class: "soft complaint" });
  const who = h("span", { class: "who" }, name, badges);
  const text = h("div", { class: "row-text" }, who, words, details, complaint);
  const box = h("li", { class: "row person" }, dot, text);
  return { box, dot, name, badges, words, details, complaint };
}
type Row = ReturnType<typeof makeRow>;

const ms = (v: number): string => `${Math.round(v * 1000)} ms`;

function detailWords(r: Reading, refused: number): string {
  const parts = [
    `jitter ${ms(r.jitter)}, buffer ${ms(r.buffer)}`,
    `${r.outOfOrder} out of order`,
    `${r.malformed + refused} malformed`,
  ];
  if (r.replayed) parts.push(`${r.replayed} replayed`);
  if (r.flooded) parts.push(`${r.flooded} too many`);
  return parts.join(" · ");
}

export class People {
  details = false;
  private readonly list = byId("people", HTMLElement);
  private readonly rows = new Map<string, Row>();

  show(people: readonly PersonRow[]): void {
    byId("people-empty", HTMLElement).hidden = people.length > 0;
    setCount("people", people.length);
    const here = new Set(people.map((p) => p.id));
    for (const [id, row] of this.rows) {
      if (here.has(id)) continue;
      row.box.remove();
      this.rows.delete(id);
    }
    people.forEach((p, i) => {
      const row = this.rows.get(p.id) ?? makeRow();
      this.rows.set(p.id, row);
      if (this.list.children[i] !== row.box) this.list.insertBefore(row.box, this.list.children[i] ?? null);
      this.fill(row, p);
    });
  }

  private fill(row: Row, p: PersonRow): void {
    setText(row.name, p.name);
    setText(row.badges, [p.me ? "you" : "", p.chair ? "chair" : ""].filter(Boolean).join(", "));
    const q = qualityText(p.reading);
    const quiet = p.reading.silent === null;
    setText(row.words, quiet ? (p.tracker ? "No motion yet" : "No tracker") : q.words);
    row.dot.className = `dot ${quiet ? "" : q.level}`;
    row.details.hidden = !this.details || (quiet && p.refused === 0 && p.reading.malformed === 0);
    if (!row.details.hidden) setText(row.details, detailWords(p.reading, p.refused));
    row.complaint.hidden = !p.complaint;
    setText(row.complaint, p.complaint);
  }
}
