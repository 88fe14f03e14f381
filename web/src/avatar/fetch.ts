// SPDX-License-Identifier: Apache-2.0
// Avatar files over HTTP.

import { labelOf } from "../shared/dom";
import { drawsInSoftware } from "../shared/graphics";
import { AvatarError } from "./inspect";

interface Fetched {
  name: string;
  data: ArrayBuffer;
}

/** One of the program's avatars; a light one for browsers without a graphics card. */
export async function fromProgram(look: string): Promise<Fetched> {
  const light = drawsInSoftware() ? "-light" : "";
  const answer = await fetch(`/avatars/${encodeURIComponent(look + light)}.vrm`);
  if (!answer.ok) throw new AvatarError(`Telemime has no avatar "${labelOf(look)}".`);
  return { name: labelOf(look), data: await answer.arrayBuffer() };
}

/** ms for a whole file: the largest, of 200 MB, at 5 Mbit/s. */
const TIMEOUT = 320_000;

/** A file at any address that this page may read. Throws other errors than AvatarError where it cannot be reached. */
export async function fromAddress(url: URL): Promise<Fetched> {
  const answer = await fetch(url, { credentials: "omit", signal: AbortSignal.timeout(TIMEOUT) });
  if (!answer.ok) throw new AvatarError(`There is no avatar at ${url.href} (status ${answer.status}).`);
  return { name: url.pathname.split("/").pop()!, data: await answer.arrayBuffer() };
}
