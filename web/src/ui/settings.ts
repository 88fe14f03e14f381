// SPDX-License-Identifier: Apache-2.0
// What the user chose, kept in this browser.

export interface Settings {
  mirrorPicture: boolean;
  mirrorAvatar: boolean;
  overlay: boolean;
  closeUp: boolean;
  panelClosed: boolean; // on a wide page
  tab: "avatar" | "send" | "recordings";
  /** "look:NAME" of the program's own, or "own:ID" of the browser's store; empty: the program's first. */
  avatar: string;
  keys: boolean; // single-key shortcuts
}

export const DEFAULTS: Readonly<Settings> = {
  mirrorPicture: true,
  mirrorAvatar: false,
  overlay: true,
  closeUp: false,
  panelClosed: false,
  tab: "avatar",
  avatar: "",
  keys: true,
};

const KEY = "telemime";

/** Stored text to settings; what is missing or of the wrong kind takes its default. */
export function readSettings(stored: string | null): Settings {
  const out: Settings = { ...DEFAULTS };
  let given: unknown = null;
  try {
    given = JSON.parse(stored ?? "null");
  } catch {
    // broken: defaults
  }
  if (typeof given !== "object" || given === null) return out;
  const g = given as Record<string, unknown>;
  for (const key of ["mirrorPicture", "mirrorAvatar", "overlay", "closeUp", "panelClosed", "keys"] as const) {
    const v = g[key];
    if (typeof v === "boolean") out[key] = v;
  }
  if (g.tab === "avatar" || g.tab === "send" || g.tab === "recordings") out.tab = g.tab;
  if (typeof g.avatar === "string" && g.avatar.length < 200) out.avatar = g.avatar;
  return out;
}

export function loadSettings(): Settings {
  try {
    return readSettings(localStorage.getItem(KEY));
  } catch {
    return { ...DEFAULTS };
  }
}

/** What differs from `before`. */
export function changed(s: Settings, before: Settings): Partial<Settings> {
  const keys = Object.keys(s) as (keyof Settings)[];
  return Object.fromEntries(keys.filter((key) => s[key] !== before[key]).map((key) => [key, s[key]]));
}

/** Keeps what has changed since `before`, and nothing else: another window may have kept other choices. */
export function saveSettings(s: Settings, before: Settings): void {
  try {
    localStorage.setItem(KEY, JSON.stringify({ ...loadSettings(), ...changed(s, before) }));
  } catch {
    // A browser that keeps nothing: the settings hold until the page is closed.
  }
}
