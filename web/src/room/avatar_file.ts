// SPDX-License-Identifier: Apache-2.0
// Files of avatars: the room's own, and those of participants by HTTPS, which are what their participant said or are
// not used at all.

import { STRANGERS, checkBounds, type Bounds } from "../avatar/bounds";
import { AvatarError, inspect } from "../avatar/inspect";
import { sha256 } from "../sha256";
import { MAX_AVATAR, avatarUrl, type AvatarChoice } from "./messages";

type File = Extract<AvatarChoice, { url: string }>;

/** Without a graphics card a stranger's avatar may cost about as much as one of the project's. */
export const LIGHT_STRANGERS: Readonly<Bounds> = { ...STRANGERS, triangles: 70_000 };
const PATIENCE = 60_000; // ms for a whole file

const tooLong = (): AvatarError =>
  new AvatarError("The avatar's file is longer than its owner said, or than 64 MB.");

/** The body of an answer, at most `most` bytes: what is longer is not read to its end. */
async function bodyOf(answer: Response, most: number): Promise<Uint8Array<ArrayBuffer>> {
  if (Number(answer.headers.get("content-length") ?? 0) > most) throw tooLong();
  const reader = answer.body?.getReader();
  if (!reader) throw new AvatarError("The avatar's file is empty.");
  const parts: Uint8Array[] = [];
  let length = 0;
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    length += part.value.length;
    if (length > most) {
      void reader.cancel().catch(() => undefined);
      throw tooLong();
    }
    parts.push(part.value);
  }
  const all = new Uint8Array(length);
  let at = 0;
  for (const p of parts) {
    all.set(p, at);
    at += p.length;
  }
  return all;
}

/** Fetches by HTTPS, without telling who asks; throws AvatarError in words. */
async function fetchFile(url: string, most: number, fetcher: typeof fetch): Promise<Uint8Array<ArrayBuffer>> {
  const host = new URL(url).host;
  try {
    const answer = await fetcher(url, {
      credentials: "omit",
      referrerPolicy: "no-referrer",
      signal: AbortSignal.timeout(PATIENCE),
    });
    if (answer.url && !avatarUrl(answer.url))
      throw new AvatarError(`${host} leads to a place that is not safe.`);
    if (!answer.ok) throw new AvatarError(`${host} does not have the avatar's file (${answer.status}).`);
    return await bodyOf(answer, most);
  } catch (e) {
    if (e instanceof AvatarError) throw e;
    throw new AvatarError(
      `The avatar's file could not be fetched from ${host}. Does it let other pages use it (CORS)?`,
    );
  }
}

/** A participant's file: as long as said, with the hash that was said, and of bearable size when it is built. */
export async function strangersFile(
  file: File,
  bounds: Bounds,
  fetcher: typeof fetch = fetch,
): Promise<ArrayBuffer> {
  const data = await fetchFile(file.url, Math.min(file.bytes, MAX_AVATAR), fetcher);
  if (data.length !== file.bytes || (await sha256(data)) !== file.sha256)
    throw new AvatarError("The avatar's file is not the one that its owner chose: it was changed since.");
  inspect(data.buffer);
  checkBounds(data.buffer, bounds);
  return data.buffer;
}

/** What to tell the room about a file that this person wants to use; throws AvatarError in words. */
export async function describeFile(address: string, fetcher: typeof fetch = fetch): Promise<File> {
  const url = avatarUrl(address.trim());
  if (!url) throw new AvatarError("The address must begin with https:// and hold no password.");
  const data = await fetchFile(url, MAX_AVATAR, fetcher);
  inspect(data.buffer);
  checkBounds(data.buffer);
  return { url, sha256: await sha256(data), bytes: data.length };
}

/** One of the room's own avatars. */
export async function ownLook(
  look: string,
  light: boolean,
  fetcher: typeof fetch = fetch,
): Promise<ArrayBuffer> {
  const answer = await fetcher(`/avatars/${encodeURIComponent(look + (light ? "-light" : ""))}.vrm`);
  if (!answer.ok) throw new AvatarError(`The room does not have the avatar "${look}".`);
  return (await bodyOf(answer, MAX_AVATAR)).buffer;
}
