// SPDX-License-Identifier: Apache-2.0
// Names for display: plain, short, and no two the same.

const UNSEEN = /[\p{Cc}\u200b\u200e\u200f\u2028-\u202e\u2060-\u2069\ufeff]/gu; // controls, and characters that reorder or hide text
const MARKS = /(\p{M}{3})\p{M}+/gu; // stacks of accents

/** The text as one line without characters that reorder, hide or stack text; at most `most` characters. */
export function plainLine(text: string, most: number): string {
  const line = text.replace(UNSEEN, "").replace(MARKS, "$1").replace(/\s+/gu, " ").trim();
  const all = [...line];
  return all.length <= most ? line : `${all.slice(0, most - 1).join("")}…`;
}

/** As plainLine, but with its lines, for the chat. */
export function plainText(text: string): string {
  return text
    .split(/\r\n|[\n\r\u2028\u2029]/u)
    .slice(0, 20)
    .map((l) => l.replace(/\t/g, " ").replace(UNSEEN, "").replace(MARKS, "$1"))
    .join("\n");
}

/** "3" for p03; other ids as they are. */
const numberOf = (id: string): string => /^p0*(\d+)$/.exec(id)?.[1] ?? id;

/** Names that look alike give the same key. */
const lookKey = (name: string): string => name.normalize("NFKC").toLowerCase().replace(/\s/gu, "");

/** The displayed name of each participant. Equal names get the numbers of their participants. */
export function shownNames(names: ReadonlyMap<string, string>): Map<string, string> {
  const plain = new Map([...names].map(([id, name]) => [id, plainLine(name, 40) || id]));
  const count = new Map<string, number>();
  for (const name of plain.values()) count.set(lookKey(name), (count.get(lookKey(name)) ?? 0) + 1);
  return new Map(
    [...plain].map(([id, name]) => [id, count.get(lookKey(name))! > 1 ? `${name} (${numberOf(id)})` : name]),
  );
}
