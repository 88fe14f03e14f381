// SPDX-License-Identifier: Apache-2.0
// The command that lets one's camera move one's avatar.

import type { Entered } from "./entry";
import type { MyState } from "./me";
import { plainLine } from "./names";

/** For an address within single quotes: nothing in it ends them. */
const encode = (text: string): string =>
  encodeURIComponent(text).replace(/['!()*]/g, (c) => `%${c.charCodeAt(0).toString(16).toUpperCase()}`);

/**
 * `telemime live --send '...'` as this participant, with the password in it; null when the room does not say where programs
 * reach its broker, or the person only watches.
 */
export function trackerCommand(entered: Entered, state: MyState | null): string | null {
  const { tcp, user, password, participant, topic } = entered;
  if (!tcp || !participant || !state) return null;
  const [scheme, host] = tcp.split("://") as [string, string];
  const [, tenant, room] = topic.split("/") as [string, string, string];
  const options: string[] = [];
  const name = plainLine(state.name, 40);
  if (name) options.push(`name=${encode(name)}`);
  if (state.avatar && "look" in state.avatar) options.push(`look=${encode(state.avatar.look)}`);
  if (state.seat !== null) options.push(`seat=${state.seat}`);
  if (user !== `${room}.${participant}`) options.push(`participant=${participant}`);
  const rest = options.length ? `?${options.join("&")}` : "";
  const account = `${encode(user)}:${encode(password)}`;
  return `telemime live --send '${scheme}://${account}@${host}/${tenant}/${room}${rest}'`;
}
