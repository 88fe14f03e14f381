// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { readSeats, readTitle } from "./chair_requests";

describe("a title", () => {
  it("is a line of 60 characters or 200 bytes", () => {
    expect(readTitle("  Blue\t room\u202e ")).toEqual({ title: "Blue room" });
    expect(readTitle("é".repeat(60))).toEqual({ title: "é".repeat(60) });
    expect(readTitle("🪑".repeat(50))).toEqual({ title: "🪑".repeat(50) });
    for (const long of ["x".repeat(61), "🪑".repeat(51)])
      expect(readTitle(long)).toEqual({ words: "The title is too long: at most 60 characters." });
    for (const none of ["", " \n", "\u200b"]) expect(readTitle(none)).toEqual({ words: "Enter a title." });
  });
});

describe("a number of seats", () => {
  it("is from 1 to 100", () => {
    expect(["1", " 8 ", "100", "007"].map(readSeats)).toEqual([1, 8, 100, 7]);
    for (const none of ["0", "101", "", "-1", "2.5", "1e1", "eight", "0x8"])
      expect(readSeats(none)).toBeNull();
  });
});
