// SPDX-License-Identifier: Apache-2.0
// What the person chose on the room's page, kept in this browser.

export interface RoomSettings {
  panelClosed: boolean; // on a wide page
  tab: "people" | "chat" | "room";
  keys: boolean; // single-key shortcuts
  /** Fetch avatars that participants keep at other web sites: those sites then see who asks. */
  strangers: boolean;
  /** How motion arrives, of each participant. */
  details: boolean;
}

export const DEFAULTS: Readonly<RoomSettings> = {
  panelClosed: false,
  tab: "people",
  keys: true,
  strangers: true,
  details: false,
};

const KEY = "telemime-room-settings";

/** Stored text to settings; what is missing or of the wrong kind takes its default. */
export function readRoomSettings(stored: string | null): RoomSettings {
  const out: RoomSettings = { ...DEFAULTS };
  let given: unknown = null;
  try {
    given = JSON.parse(stored ?? "null");
  } catch {
    // broken: defaults
  }
  if (typeof given !== "object" || given === null) return out;
  const g = given as Record<string, unknown>;
  for (const key of ["panelClosed", "keys", "strangers", "details"] as const) {
    const v = g[key];
    if (typeof v === "boolean") out[key] = v;
  }
  if (g.tab === "people" || g.tab === "chat" || g.tab === "room") out.tab = g.tab;
  return out;
}

export function loadRoomSettings(): RoomSettings {
  try {
    return readRoomSettings(localStorage.getItem(KEY));
  } catch {
    return { ...DEFAULTS };
  }
}

export function saveRoomSettings(s: RoomSettings): void {
  try {
    localStorage.setItem(KEY, JSON.stringify(s));
  } catch {
    // A browser that keeps nothing: the settings hold until the page is closed.
  }
}
