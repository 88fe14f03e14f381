// SPDX-License-Identifier: Apache-2.0
// What the user chose, stored in this browser.

import * as v from "valibot";

/** A boolean setting. */
export const flag = (otherwise: boolean) => v.fallback(v.boolean(), otherwise);

/** Reads stored text by a schema that has a fallback for each entry. */
export function parseStored<T extends v.GenericSchema>(schema: T, stored: string | null): v.InferOutput<T> {
  let given: unknown = null;
  try {
    given = JSON.parse(stored ?? "null");
  } catch {
    // Broken text: the defaults.
  }
  const result = v.safeParse(schema, given);
  return result.success ? result.output : v.parse(schema, {});
}

/** An object in localStorage. A browser that stores nothing keeps it until the page is closed. */
export class Stored<T extends object> {
  private saved: T;

  constructor(
    private readonly key: string,
    private readonly schema: v.GenericSchema<unknown, T>,
  ) {
    this.saved = this.load();
  }

  /** What is stored now; what is missing or malformed takes its default. */
  load(): T {
    try {
      return parseStored(this.schema, localStorage.getItem(this.key));
    } catch {
      return parseStored(this.schema, null);
    }
  }

  /** Stores what has changed since the last call, and nothing else: another window may have stored other choices. */
  save(value: T): void {
    const keys = Object.keys(value) as (keyof T)[];
    const changed = keys.filter((key) => value[key] !== this.saved[key]).map((key) => [key, value[key]]);
    this.saved = { ...value };
    try {
      localStorage.setItem(this.key, JSON.stringify({ ...this.load(), ...Object.fromEntries(changed) }));
    } catch {
      // Nothing can be stored here.
    }
  }
}
