// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { plainLine, plainText, shownNames } from "./names";

const shown = (...names: [string, string][]): string[] => [...shownNames(new Map(names)).values()];

describe("names", () => {
  it("stay as they are when they differ", () => {
    expect(shown(["p01", "Ana"], ["p02", "Bo"])).toEqual(["Ana", "Bo"]);
  });
  it("that look alike get their numbers", () => {
    expect(shown(["p01", "Ana"], ["p12", "ana"], ["p03", "Bo"])).toEqual(["Ana (1)", "ana (12)", "Bo"]);
    expect(shown(["p01", "Ana"], ["guest", "Ａｎａ"])).toEqual(["Ana (1)", "Ａｎａ (guest)"]);
    expect(shown(["p01", "Ana"], ["p02", "An\u200ba"])).toEqual(["Ana (1)", "Ana (2)"]);
  });
  it("that are invisible become the id", () => {
    expect(shown(["p01", "\u202e \u200b"])).toEqual(["p01"]);
  });
  it("are one line without control characters", () => {
    expect(plainLine("a\u202eb\n\tc\u0007", 40)).toBe("abc");
    expect(plainLine(" a   b ", 40)).toBe("a b");
    expect(plainLine("x".repeat(100), 40)).toBe("x".repeat(39) + "…");
    expect([...plainLine("😀".repeat(100), 40)].length).toBe(40);
    expect(plainLine(`a${"\u0301".repeat(50)}`, 40)).toBe(`a${"\u0301".repeat(3)}`);
  });
  it("with markup stay text", () => {
    const script = "<script>alert(1)</script>";
    expect(shown(["p01", script])).toEqual([script]);
  });
});

describe("text of a chat", () => {
  it("keeps its lines, within reason", () => {
    expect(plainText("a\nb\r\nc\td")).toBe("a\nb\nc d");
    expect(plainText("\n".repeat(400)).split("\n").length).toBe(20);
    expect(plainText("a\u202eb\u2066c")).toBe("abc");
  });
});
