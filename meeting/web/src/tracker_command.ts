// SPDX-License-Identifier: Apache-2.0
// The command that lets the user's camera move the avatar.

import type { Entered } from "./entry";
import type { OwnState } from "./local_participant";
import { plainLine } from "./names";

/** Escapes a part of an address within single quotes. */
const encode = (text: string): string =>
  encodeURIComponent(text).replace(/['!()*]/g, (c) => `%${c.charCodeAt(0).toString(16).toUpperCase()}`);

/**
 * `telemime live --send '...'` as this participant, including the password; null when the server does not publish the MQTT
 * address of the broker, or the user only watches.
 */
export function trackerCommand(entered: Entered, state: OwnState | null): string | null {
  const { tcp, user, password, participant, topic } = entered;
  if (!tcp || !participant || !state) return null;
  const [scheme, host] = tcp.split("://") as [string, string];
  const [, tenant, meeting] = topic.split("/") as [string, string, string];
  const options: string[] = [];
  const name = plainLine(state.name, 40);
  if (name) options.push(`name=${encode(name)}`);
  if (state.avatar && "look" in state.avatar) options.push(`look=${encode(state.avatar.look)}`);
  if (state.seat !== null) options.push(`seat=${state.seat}`);
  if (user !== `${meeting}.${participant}`) options.push(`participant=${participant}`);
  const rest = options.length ? `?${options.join("&")}` : "";
  const account = `${encode(user)}:${encode(password)}`;
  return `telemime live --send '${scheme}://${account}@${host}/${tenant}/${meeting}${rest}'`;
}
