// SPDX-License-Identifier: Apache-2.0
// What the user chose on the live page.

import * as v from "valibot";
import { Stored, flag, parseStored } from "../shared/stored";

export const SettingsSchema = v.object({
  mirrorPicture: flag(true),
  mirrorAvatar: flag(false),
  overlay: flag(true),
  closeUp: flag(false),
  panelClosed: flag(false), // on a wide page
  tab: v.fallback(v.picklist(["avatar", "send", "recordings"]), "avatar"),
  /** "look:NAME" of the program's own, or "own:ID" of the browser's store; empty: the program's first. */
  avatar: v.fallback(v.pipe(v.string(), v.maxLength(199)), ""),
  keys: flag(true), // single-key shortcuts
});
export type Settings = v.InferOutput<typeof SettingsSchema>;

export const DEFAULTS: Readonly<Settings> = parseStored(SettingsSchema, null);

export const storedSettings = () => new Stored<Settings>("telemime", SettingsSchema);
