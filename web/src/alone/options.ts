// SPDX-License-Identifier: Apache-2.0
// What the address of the avatar's page asks for: /avatar?framing=head&background=green

import { FRAMINGS, type Framing } from "../avatar/framing";

export interface Options {
  /** A name of one of the program's avatars, or the address of a file; null: the program's first one. */
  avatar: string | URL | null;
  framing: Framing;
  /** Size of the picture in pixels of the page; null: the window's. */
  width: number | null;
  height: number | null;
  /** A colour of CSS. */
  background: string;
  mirror: boolean;
  /** Show what goes wrong while it runs. */
  debug: boolean;
}

export const OPTIONS = ["avatar", "framing", "width", "height", "background", "mirror", "debug"] as const;

const GREEN = "#00ff00"; // what OBS's chroma key takes away
const MOST = 7680; // pixels

/** URL.canParse is newer than the browser in many versions of OBS. */
function urlOf(text: string, base: string): URL | null {
  try {
    return new URL(text, base);
  } catch {
    return null;
  }
}

/** Reads the page's own address; `mistakes` are words for the user. */
export function readOptions(address: string): { options: Options; mistakes: string[] } {
  // A colour may be written with its "#", which would begin the fragment of an address.
  const query = address.includes("?") ? address.slice(address.indexOf("?") + 1) : "";
  const given = new URLSearchParams(query);
  const mistakes: string[] = [];
  for (const name of new Set(given.keys())) {
    if (!OPTIONS.some((o) => o === name))
      mistakes.push(`There is no option "${name}". The options are ${OPTIONS.join(", ")}.`);
  }
  const wrong = (name: string, rule: string): null => {
    mistakes.push(`"${name}" cannot be "${given.get(name)}": ${rule}.`);
    return null;
  };
  const one = <T extends string>(name: string, values: readonly T[]): T => {
    const value = given.get(name) ?? values[0]!;
    return values.find((v) => v === value) ?? wrong(name, `it is one of ${values.join(", ")}`) ?? values[0]!;
  };
  const pixels = (name: string): number | null => {
    const value = given.get(name);
    if (value === null) return null;
    const size = /^\d+$/.test(value) ? Number(value) : 0;
    return size >= 16 && size <= MOST ? size : wrong(name, `it is a number of pixels from 16 to ${MOST}`);
  };
  const colour = (): string => {
    const value = given.get("background") ?? "transparent";
    if (value === "transparent") return value;
    if (value === "green") return GREEN;
    const hex = /^#?([0-9a-f]{6})$/i.exec(value)?.[1];
    return hex ? `#${hex}` : (wrong("background", "it is transparent, green or a colour like #20a060"), "");
  };
  const avatar = (): string | URL | null => {
    const value = given.get("avatar");
    if (value === null || /^[A-Za-z0-9_-]+$/.test(value)) return value;
    const url = /[/.]/.test(value) ? urlOf(value, address) : null;
    const rule = "it is the name of an avatar of Telemime, or the address (http or https) of a VRM file";
    return url && /^https?:$/.test(url.protocol) ? url : wrong("avatar", rule);
  };
  const options: Options = {
    avatar: avatar(),
    framing: one("framing", FRAMINGS),
    width: pixels("width"),
    height: pixels("height"),
    background: colour(),
    mirror: one("mirror", ["0", "1"]) === "1",
    debug: given.has("debug"),
  };
  return { options, mistakes };
}
