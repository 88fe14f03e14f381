// SPDX-License-Identifier: Apache-2.0
// What the user chose on the meeting's page.

import * as v from "valibot";
import { Stored, flag } from "#web/shared/stored";

const SettingsSchema = v.object({
  panelClosed: flag(false), // on a wide page
  tab: v.fallback(v.picklist(["people", "chat", "meeting"]), "people"),
  keys: flag(true), // single-key shortcuts
  /** Download avatars that participants keep on other websites, which then see who asks. */
  strangers: flag(true),
  /** Show how the motion of each participant arrives. */
  details: flag(false),
});
export type MeetingSettings = v.InferOutput<typeof SettingsSchema>;

export const storedSettings = () => new Stored<MeetingSettings>("telemime-room-settings", SettingsSchema);
