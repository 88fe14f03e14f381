// SPDX-License-Identifier: Apache-2.0
// Avatars for participants: each file is fetched once, and those of one file share their surfaces and pictures.

import { Mesh, type Material, type Object3D, type Texture } from "three";
import { STRANGERS } from "../bounds";
import { loadAvatar, type Avatar } from "#web/avatar/load";
import { drawsInSoftware } from "#web/shared/graphics";
import { LIGHT_STRANGERS, ownLook, strangersFile } from "../avatar_file";
import type { AvatarChoice } from "../messages";

/** Limit of the bytes of participants' files at a time. */
const MOST_BYTES = 256 * 1024 * 1024;
const PAUSE = 20; // ms between avatars that are built

/** Equal for equal files from the same place: a place that fails or lies affects only those who name it. */
export const keyOf = (choice: AvatarChoice): string =>
  "look" in choice ? `look:${choice.look}` : `file:${choice.sha256} ${choice.url}`;

interface Entry {
  data: Promise<ArrayBuffer>;
  bytes: number;
  users: Set<Avatar>;
  waiting: number;
  /** The avatar whose surfaces the others use. */
  first: Avatar | null;
}

const meshes = (of: Object3D): Mesh[] => {
  const out: Mesh[] = [];
  of.traverse((o) => {
    if (o instanceof Mesh) out.push(o);
  });
  return out;
};

function forget(material: Material | Material[]): void {
  for (const m of [material].flat()) {
    for (const value of Object.values(m) as unknown[]) {
      const t = value as Texture | null;
      if (!t?.isTexture) continue;
      (t.source?.data as { close?: () => void } | null)?.close?.();
      t.dispose();
    }
    m.dispose();
  }
}

/** Replaces the surfaces of `to` by those of `from`, which is of the same file. */
function shareSurfaces(from: Object3D, to: Object3D): void {
  const a = meshes(from);
  const b = meshes(to);
  if (a.length !== b.length) return;
  const own = new Set<Material | Material[]>();
  b.forEach((mesh, i) => {
    const other = a[i]!;
    if (mesh.geometry.getAttribute("position")?.count !== other.geometry.getAttribute("position")?.count)
      return;
    own.add(mesh.material as Material | Material[]);
    mesh.geometry.dispose();
    mesh.geometry = other.geometry;
    mesh.material = other.material;
  });
  own.forEach(forget);
}

export class AvatarLibrary {
  private readonly entries = new Map<string, Entry>();
  private last: Promise<unknown> = Promise.resolve();
  private readonly keys = new WeakMap<Avatar, string>();

  /** A new avatar for one participant; give it back with release(). Throws AvatarError. */
  async make(choice: AvatarChoice): Promise<Avatar> {
    const key = keyOf(choice);
    const entry = this.entry(key, choice);
    entry.waiting++;
    try {
      const data = await entry.data;
      const avatar = await this.inTurn(() => loadAvatar(data));
      if (entry.first) shareSurfaces(entry.first.scene, avatar.scene);
      else entry.first = avatar;
      entry.users.add(avatar);
      this.keys.set(avatar, key);
      return avatar;
    } catch (e) {
      if (entry.users.size === 0) this.entries.delete(key); // the next request tries again
      throw e;
    } finally {
      entry.waiting--;
    }
  }

  /** Builds avatars one after the other, with pauses for the rest of the page. */
  private inTurn<T>(work: () => Promise<T>): Promise<T> {
    const done = this.last.then(work);
    this.last = done
      .catch(() => undefined)
      .then(() => new Promise<void>((resolve) => void window.setTimeout(resolve, PAUSE)));
    return done;
  }

  release(avatar: Avatar): void {
    const key = this.keys.get(avatar);
    const entry = key === undefined ? undefined : this.entries.get(key);
    if (!entry?.users.delete(avatar)) return;
    // The surfaces are shared: they are freed with the last avatar.
    if (entry.users.size > 0 || entry.waiting > 0) return;
    avatar.dispose();
    this.entries.delete(key!);
  }

  private entry(key: string, choice: AvatarChoice): Entry {
    const known = this.entries.get(key);
    if (known) return known;
    const bytes = "look" in choice ? 0 : choice.bytes;
    const kept = [...this.entries.values()].reduce((n, e) => n + e.bytes, 0);
    const light = drawsInSoftware();
    const made: Entry = {
      data:
        "look" in choice
          ? ownLook(choice.look, light)
          : kept + bytes > MOST_BYTES
            ? Promise.reject(new Error("too many large avatars"))
            : strangersFile(choice, light ? LIGHT_STRANGERS : STRANGERS),
      bytes,
      users: new Set(),
      waiting: 0,
      first: null,
    };
    made.data.catch(() => undefined); // make() reports it
    this.entries.set(key, made);
    return made;
  }
}
