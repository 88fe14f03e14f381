// SPDX-License-Identifier: Apache-2.0
import { expect, it } from "vitest";
import { displacedBy } from "./store";

const stored = (...names: string[]): { id: string; name: string; bytes: number }[] =>
  names.map((name, i) => ({ id: String(i), name, bytes: 1 }));
const names = (name: string, ...before: string[]): string[] =>
  displacedBy(name, stored(...before)).map((e) => e.name);

it("displaces the oldest of eight avatars", () => {
  expect(names("i", "a", "b", "c", "d", "e", "f", "g", "h")).toEqual(["a"]);
  expect(names("h", "a", "b", "c", "d", "e", "f", "g")).toEqual([]);
});

it("replaces one of the same name, and no other", () => {
  expect(names("d", "a", "b", "c", "d", "e", "f", "g", "h")).toEqual(["d"]);
  expect(names("a", "a")).toEqual(["a"]);
});
