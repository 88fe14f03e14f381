// SPDX-License-Identifier: Apache-2.0
// The user's avatar files, stored in this browser (IndexedDB). They are not sent anywhere.

export interface StoredAvatar {
  id: string;
  name: string;
  bytes: number;
  data: ArrayBuffer;
}

export type StoredEntry = Omit<StoredAvatar, "data">;

const DATABASE = "telemime";
const FILES = "avatar-files"; // id -> StoredAvatar
const ENTRIES = "avatar-list"; // id -> StoredEntry: the list does not read the files
const MAX_FILES = 8;

function done<T>(request: IDBRequest<T>): Promise<T> {
  return new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error ?? new Error("IndexedDB"));
  });
}

function open(): Promise<IDBDatabase> {
  const request = indexedDB.open(DATABASE, 1);
  request.onupgradeneeded = () => {
    request.result.createObjectStore(FILES, { keyPath: "id" });
    request.result.createObjectStore(ENTRIES, { keyPath: "id" });
  };
  return done(request);
}

async function change(what: (files: IDBObjectStore, entries: IDBObjectStore) => void): Promise<void> {
  const db = await open();
  try {
    const t = db.transaction([FILES, ENTRIES], "readwrite");
    await new Promise<void>((resolve, reject) => {
      t.oncomplete = () => resolve();
      t.onerror = t.onabort = () => reject(t.error ?? new Error("IndexedDB"));
      what(t.objectStore(FILES), t.objectStore(ENTRIES));
    });
  } finally {
    db.close();
  }
}

/** Oldest first; empty when the browser stores nothing (private window). */
export async function listAvatars(): Promise<StoredEntry[]> {
  try {
    const db = await open();
    try {
      const all = await done(db.transaction(ENTRIES).objectStore(ENTRIES).getAll());
      return (all as StoredEntry[]).sort((a, b) => a.id.localeCompare(b.id));
    } finally {
      db.close();
    }
  } catch {
    return [];
  }
}

export async function getAvatar(id: string): Promise<StoredAvatar | null> {
  const db = await open();
  try {
    return (
      ((await done(db.transaction(FILES).objectStore(FILES).get(id))) as StoredAvatar | undefined) ?? null
    );
  } finally {
    db.close();
  }
}

/** Stores the file. It replaces one of the same name; of more than 8 the oldest is removed. Throws without space. */
export async function putAvatar(name: string, data: ArrayBuffer): Promise<StoredEntry> {
  const id = `${Date.now().toString().padStart(15, "0")}-${Math.random().toString(36).slice(2, 8)}`;
  const entry: StoredEntry = { id, name, bytes: data.byteLength };
  const before = await listAvatars();
  const gone = before.filter((e, i) => e.name === name || i < before.length - (MAX_FILES - 1));
  await change((files, entries) => {
    for (const e of gone) {
      files.delete(e.id);
      entries.delete(e.id);
    }
    files.put({ ...entry, data } satisfies StoredAvatar);
    entries.put(entry);
  });
  return entry;
}

export function removeAvatar(id: string): Promise<void> {
  return change((files, entries) => {
    files.delete(id);
    entries.delete(id);
  });
}
