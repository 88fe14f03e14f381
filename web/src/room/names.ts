// SPDX-License-Identifier: Apache-2.0
// Names as they are shown: plain, short, and no two the same.

const UNSEEN = /[\p{Cc}\u200b\u200e\u200f\u2028-\u202e\u2060-\u2069\ufeff]/gu; // controls, and what turns or hides text
const MARKS = /(\p{M}{3})\p{M}+/gu; // piles of accents

/** Fit for one line: nothing that turns, hides or piles up text; at most `most` characters. */
export function plainLine(text: string, most: number): string {
  const line = text.replace(UNSEEN, "").replace(MARKS, "$1").replace(/\s+/gu, " ").trim();
  const all = [...line];
  return all.length <= most ? line : `${all.slice(0, most - 1).join("")}…`;
}

/** For the text of a chat: as plainLine, but lines stay. */
export function plainText(text: string): string {
  return text
    .split(/\r\n|[\n\r\u2028\u2029]/u)
    .slice(0, 20)
    .map((l) => l.replace(/\t/g, " ").replace(UNSEEN, "").replace(MARKS, "$1"))
    .join("\n");
}

/** p03 -> 3; of other ids the id. */
const numberOf = (id: string): string => /^p0*(\d+)$/.exec(id)?.[1] ?? id;

/** Two names that look alike are one here. */
const alike = (name: string): string => name.normalize("NFKC").toLowerCase().replace(/\s/gu, "");

/** What each participant is called; of the same name, each has its number. */
export function shownNames(names: ReadonlyMap<string, string>): Map<string, string> {
  const plain = new Map([...names].map(([id, name]) => [id, plainLine(name, 40) || id]));
  const count = new Map<string, number>();
  for (const name of plain.values()) count.set(alike(name), (count.get(alike(name)) ?? 0) + 1);
  return new Map(
    [...plain].map(([id, name]) => [id, count.get(alike(name))! > 1 ? `${name} (${numberOf(id)})` : name]),
  );
}
