// SPDX-License-Identifier: Apache-2.0
// Files of avatars: those of the meeting's server, and those of participants by HTTPS, which must have the announced hash
// and size.

import { sha256 } from "@noble/hashes/sha2";
import { bytesToHex } from "@noble/hashes/utils";
import { AvatarError, inspect } from "#web/avatar/inspect";
import { STRANGERS, checkBounds, type Bounds } from "./bounds";
import { MAX_AVATAR, avatarUrl, type AvatarChoice } from "./messages";

type File = Extract<AvatarChoice, { url: string }>;

/** Without a graphics card a participant's avatar may cost about as much as one of the project's. */
export const LIGHT_STRANGERS: Readonly<Bounds> = { ...STRANGERS, triangles: 70_000 };
const TIMEOUT = 60_000; // ms for a whole file

/** The server cannot be reached, or does not work, at the moment. */
export class UnreachableError extends AvatarError {}

const tooLong = (): AvatarError =>
  new AvatarError("The avatar's file is larger than announced, or than 64 MB.");

/** The body of a response, at most `most` bytes: reading a longer one stops. */
async function bodyOf(answer: Response, most: number): Promise<Uint8Array<ArrayBuffer>> {
  if (Number(answer.headers.get("content-length") ?? 0) > most) throw tooLong();
  if (!answer.body) throw new AvatarError("The avatar's file is empty.");
  let length = 0;
  const limit = new TransformStream<Uint8Array, Uint8Array>({
    transform(part, controller) {
      length += part.length;
      if (length > most) controller.error();
      else controller.enqueue(part);
    },
  });
  const body = new Response(answer.body.pipeThrough(limit)).arrayBuffer();
  return new Uint8Array(
    await body.catch((e: unknown) => {
      throw length > most ? tooLong() : e;
    }),
  );
}

/** Downloads by HTTPS without credentials or referrer; throws AvatarError. */
async function fetchFile(url: string, most: number, fetcher: typeof fetch): Promise<Uint8Array<ArrayBuffer>> {
  const host = new URL(url).host;
  try {
    const answer = await fetcher(url, {
      credentials: "omit",
      referrerPolicy: "no-referrer",
      signal: AbortSignal.timeout(TIMEOUT),
    });
    if (answer.url && !avatarUrl(answer.url))
      throw new AvatarError(`${host} redirects to an address that is not secure.`);
    if (answer.status >= 500)
      throw new UnreachableError(`${host} could not send the avatar's file (${answer.status}).`);
    if (!answer.ok) throw new AvatarError(`${host} does not have the avatar's file (${answer.status}).`);
    return await bodyOf(answer, most);
  } catch (e) {
    if (e instanceof AvatarError) throw e;
    throw new UnreachableError(
      `The avatar's file could not be downloaded from ${host}. Does the server allow other pages to use it (CORS)?`,
    );
  }
}

/** A participant's file, with the announced size and hash, and within `bounds` when it is built. */
export async function strangersFile(
  file: File,
  bounds: Bounds,
  fetcher: typeof fetch = fetch,
): Promise<ArrayBuffer> {
  const data = await fetchFile(file.url, Math.min(file.bytes, MAX_AVATAR), fetcher);
  if (data.length !== file.bytes || bytesToHex(sha256(data)) !== file.sha256)
    throw new AvatarError("The avatar's file has changed since its owner chose it.");
  inspect(data.buffer);
  checkBounds(data.buffer, bounds);
  return data.buffer;
}

/** The description of a file that this user wants to use, for the other participants; throws AvatarError. */
export async function describeFile(address: string, fetcher: typeof fetch = fetch): Promise<File> {
  const url = avatarUrl(address.trim());
  if (!url) throw new AvatarError("The address must begin with https:// and contain no password.");
  const data = await fetchFile(url, MAX_AVATAR, fetcher);
  inspect(data.buffer);
  checkBounds(data.buffer);
  return { url, sha256: bytesToHex(sha256(data)), bytes: data.length };
}

/** One of the server's avatars. `light`: the version with fewer triangles. */
export async function ownLook(
  look: string,
  light: boolean,
  fetcher: typeof fetch = fetch,
): Promise<ArrayBuffer> {
  const name = encodeURIComponent(look + (light ? "-light" : ""));
  try {
    const answer = await fetcher(`/avatars/${name}.vrm`);
    if (answer.status >= 500)
      throw new UnreachableError(`The server could not send the avatar "${look}" (${answer.status}).`);
    if (!answer.ok) throw new AvatarError(`The server has no avatar "${look}".`);
    return (await bodyOf(answer, MAX_AVATAR)).buffer;
  } catch (e) {
    if (e instanceof AvatarError) throw e;
    throw new UnreachableError(`The avatar "${look}" could not be downloaded from the meeting's server.`);
  }
}
