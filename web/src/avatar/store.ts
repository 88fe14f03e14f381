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

/** Opens the database for `work`. */
async function withDatabase<T>(work: (db: IDBDatabase) => Promise<T>): Promise<T> {
  const request = indexedDB.open(DATABASE, 1);
  request.onupgradeneeded = () => {
    for (const name of [FILES, ENTRIES]) request.result.createObjectStore(name, { keyPath: "id" });
  };
  const db = await done(request);
  try {
    return await work(db);
  } finally {
    db.close();
  }
}

const change = (what: (files: IDBObjectStore, entries: IDBObjectStore) => void): Promise<void> =>
  withDatabase((db) => {
    const t = db.transaction([FILES, ENTRIES], "readwrite");
    return new Promise((resolve, reject) => {
      t.oncomplete = () => resolve();
      t.onerror = t.onabort = () => reject(t.error ?? new Error("IndexedDB"));
      what(t.objectStore(FILES), t.objectStore(ENTRIES));
    });
  });

/** Oldest first; empty when the browser stores nothing (private window). */
export async function listAvatars(): Promise<StoredEntry[]> {
  const all: Promise<StoredEntry[]> = withDatabase((db) =>
    done(db.transaction(ENTRIES).objectStore(ENTRIES).getAll()),
  );
  return (await all.catch(() => [])).sort((a, b) => a.id.localeCompare(b.id));
}

export async function getAvatar(id: string): Promise<StoredAvatar | null> {
  const request = (db: IDBDatabase): IDBRequest<StoredAvatar | undefined> =>
    db.transaction(FILES).objectStore(FILES).get(id);
  return (await withDatabase((db) => done(request(db)))) ?? null;
}

/** What a new file of this name replaces or displaces of those that are stored, the oldest first. */
export function displacedBy(name: string, stored: readonly StoredEntry[]): StoredEntry[] {
  const others = stored.filter((e) => e.name !== name);
  const same = stored.filter((e) => e.name === name);
  return [...same, ...others.slice(0, Math.max(0, others.length - (MAX_FILES - 1)))];
}

/** Stores the file. It replaces one of the same name; of more than 8 the oldest is removed. Throws without space. */
export async function putAvatar(name: string, data: ArrayBuffer): Promise<StoredEntry> {
  const id = `${Date.now().toString().padStart(15, "0")}-${Math.random().toString(36).slice(2, 8)}`;
  const entry: StoredEntry = { id, name, bytes: data.byteLength };
  const gone = displacedBy(name, await listAvatars());
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
