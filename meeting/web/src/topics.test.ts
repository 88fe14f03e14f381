// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { KINDS, boardTopic, parseTopic, meetingTopic, topicOf } from "./topics";

const BASE = "r/lab/blue_room-1";

describe("topics", () => {
  it("are parsed as they are composed", () => {
    for (const kind of KINDS) {
      expect(parseTopic(BASE, topicOf(BASE, "p01", kind))).toEqual({ kind, participant: "p01" });
    }
    for (const page of [0, 9, 10, 63]) {
      expect(parseTopic(BASE, boardTopic(BASE, "a_b-c", page))).toEqual({
        kind: "board",
        participant: "a_b-c",
        page,
      });
    }
    expect(parseTopic(BASE, `${BASE}/room`)).toEqual({ kind: "meeting" });
  });
  it("of other forms have no meaning", () => {
    for (const topic of [
      "r/lab/blue_room-12/room",
      "r/lab/other/p/p01/pose",
      BASE,
      `${BASE}/`,
      `${BASE}/rooms`,
      `${BASE}/p/p01`,
      `${BASE}/p/P01/pose`,
      `${BASE}/p//pose`,
      `${BASE}/p/p.1/pose`,
      `${BASE}/p/${"a".repeat(33)}/pose`,
      `${BASE}/p/p01/pose/`,
      `${BASE}/p/p01/constructor`,
      `${BASE}/q/p01/pose`,
      `${BASE}/p/p01/board`,
      `${BASE}/p/p01/board/64`,
      `${BASE}/p/p01/board/01`,
      `${BASE}/p/p01/board/-1`,
      `${BASE}/p/p01/board/1e1`,
      `${BASE}/p/p01/board/1/2`,
    ]) {
      expect(parseTopic(BASE, topic), topic).toBeNull();
    }
  });
  it("of a meeting are three segments", () => {
    expect(meetingTopic("r/default/main")).toBe("r/default/main");
    for (const t of ["r/a", "/r/a/b", "r/a/b/c", "x/a/b", "r/A/b", "r/a/#", "r/+/b", "", null, 3]) {
      expect(meetingTopic(t)).toBeNull();
    }
  });
});
