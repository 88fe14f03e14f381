// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import {
  LIMITS,
  MAX_AVATAR,
  readBoard,
  readChat,
  readPresence,
  readMeeting,
  readState,
  toBytes,
  writeMeeting,
} from "./messages";

const bytes = (text: string): Uint8Array => new TextEncoder().encode(text);
const SHA = "0123456789abcdef".repeat(4);
const state = (change: object = {}) => ({
  session: 7,
  kind: "tracker",
  name: "Ana",
  seat: 3,
  avatar: { look: "plain" },
  stature: 1.7,
  bones: { hips: [0, 0.94, 0] },
  ...change,
});
const stateOf = (change: object) => readState(toBytes(state(change)));

describe("state", () => {
  it("is read as it is written", () => {
    const s = stateOf({})!;
    expect(s).toMatchObject({ session: 7, kind: "tracker", name: "Ana", seat: 3, avatar: { look: "plain" } });
    expect(s.bones.get("hips")).toEqual([0, 0.94, 0]);
    const bare = stateOf({
      stature: undefined,
      bones: undefined,
      avatar: null,
      seat: null,
      kind: "browser",
    })!;
    expect(bare).toMatchObject({ avatar: null, stature: null, seat: null });
    expect(bare.bones.size).toBe(0);
  });
  it("has a name of 1 to 40 plain characters", () => {
    for (const name of ["", "x".repeat(41), "a\u0000", "a\nb", 7, null]) expect(stateOf({ name })).toBeNull();
    expect(stateOf({ name: "😀".repeat(40) })).not.toBeNull();
    expect(stateOf({ name: "<img src=x onerror=a()>" })!.name).toBe("<img src=x onerror=a()>");
  });
  it("has an avatar by look or by HTTPS", () => {
    const file = { url: "https://example.org/a.vrm", sha256: SHA, bytes: 5 };
    expect(stateOf({ avatar: file })!.avatar).toEqual(file);
    expect(stateOf({ avatar: { ...file, bytes: MAX_AVATAR } })).not.toBeNull();
    for (const avatar of [
      { ...file, bytes: MAX_AVATAR + 1 },
      { ...file, bytes: 0 },
      { ...file, sha256: SHA.toUpperCase() },
      { ...file, sha256: SHA.slice(1) },
      { ...file, url: "http://example.org/a.vrm" },
      { ...file, url: "javascript:alert(1)" },
      { ...file, url: "https://user:word@example.org/a.vrm" },
      { ...file, url: `https://example.org/${"a".repeat(3000)}` },
      { ...file, url: "/a.vrm" },
      { look: "../../etc/passwd" },
      { look: 3 },
      {},
      "plain",
    ]) {
      expect(stateOf({ avatar }), JSON.stringify(avatar).slice(0, 80)).toBeNull();
    }
  });
  it("is refused with malformed joints", () => {
    for (const hips of [[0, 1], [0, 1, "2"], [0, 1, 1e9], { x: 1 }, null]) {
      expect(stateOf({ bones: { hips } })).toBeNull();
    }
    expect(stateOf({ bones: { tail: "wags" } })!.bones.size).toBe(0);
    for (const seat of [-1, 1.5, 100, "3", null]) expect(stateOf({ seat })!.seat).toBeNull();
    for (const stature of [0, 99, "tall"]) expect(stateOf({ stature })!.stature).toBeNull();
  });
  it("is refused in another version or kind", () => {
    for (const change of [{ v: 2 }, { v: "1" }, { session: 0 }, { session: 65536 }, { kind: "god" }]) {
      expect(stateOf(change)).toBeNull();
    }
  });
});

describe("any message", () => {
  const readers = [
    [readState, LIMITS.state],
    [readPresence, LIMITS.presence],
    [readChat, LIMITS.chat],
    [readBoard, LIMITS.board],
    [readMeeting, LIMITS.meeting],
  ] as const;
  it("of another form is refused", () => {
    const nested = "[".repeat(200) + "]".repeat(200);
    for (const t of ["", "{", "null", "3", '"v"', "[1]", nested, '{"v":1}', '{"__proto__":{"v":1}}', "\0"]) {
      for (const [reader] of readers) expect(reader(bytes(t)), t).toBeNull();
    }
    for (const [reader] of readers) expect(reader(new Uint8Array([0x22, 0xff, 0xfe, 0x22]))).toBeNull();
  });
  it("that is too long is not parsed", () => {
    for (const [reader, limit] of readers) {
      const start = performance.now();
      expect(reader(bytes("[".repeat(4e6)))).toBeNull();
      expect(performance.now() - start).toBeLessThan(1000);
      expect(reader(bytes(" ".repeat(limit + 1)))).toBeNull();
    }
  });
});

describe("presence", () => {
  it("is here or not", () => {
    expect(readPresence(toBytes({ here: true, session: 9 }))).toEqual({
      here: true,
      session: 9,
      every: null,
    });
    const every = (v: unknown) => readPresence(toBytes({ here: true, session: 9, every: v }))?.every;
    expect([0.5, 1.25, 60, 0.4, 61, -1, "2", null, NaN].map(every)).toEqual([
      ...[0.5, 1.25, 60],
      ...[null, null, null, null, null, null],
    ]);
    expect(readPresence(toBytes({ here: "yes", session: 9 }))).toBeNull();
  });
  it("fits in its limit, spaces and all", () => {
    const m = { v: 1, here: true, session: 9, more: "x".repeat(300) };
    expect(readPresence(toBytes(m))).toBeNull();
  });
});

describe("chat", () => {
  it("has 1 to 500 characters", () => {
    expect(readChat(toBytes({ id: "7-1", text: "hello" }))).toEqual({ id: "7-1", text: "hello" });
    expect(readChat(toBytes({ id: "7-1", text: "é".repeat(500) }))).not.toBeNull();
    for (const text of ["", "x".repeat(501), 3, null])
      expect(readChat(toBytes({ id: "7-1", text }))).toBeNull();
  });
  it("has an id of session and number", () => {
    for (const id of ["", "a-1", "7", "7-", "-1", "123456-1", "7-12345678901", 7]) {
      expect(readChat(toBytes({ id, text: "x" })), String(id)).toBeNull();
    }
  });
});

describe("a page of the board", () => {
  const stroke = { c: "#F4f1e8", w: 40, p: [0, 0, 10000, 10000] };
  const page = (s: unknown) => readBoard(toBytes({ epoch: 2, strokes: [stroke, s] }));
  it("has strokes", () => {
    expect(page({ ...stroke, p: [5, 5] })).toEqual({
      epoch: 2,
      strokes: [
        { ...stroke, c: "#f4f1e8" },
        { ...stroke, c: "#f4f1e8", p: [5, 5] },
      ],
    });
    expect(readBoard(toBytes({ epoch: 0, strokes: [] }))).toEqual({ epoch: 0, strokes: [] });
  });
  it("is refused with a malformed stroke", () => {
    for (const s of [
      { ...stroke, c: "red" },
      { ...stroke, c: "#12345" },
      { ...stroke, c: "url(https://example.org)" },
      { ...stroke, w: 0 },
      { ...stroke, w: 5000 },
      { ...stroke, w: "4" },
      { ...stroke, p: [] },
      { ...stroke, p: [1] },
      { ...stroke, p: [1, 2, 3] },
      { ...stroke, p: [1, -2] },
      { ...stroke, p: [1, 10001] },
      { ...stroke, p: [1, 2.5] },
      { ...stroke, p: "1,2" },
      null,
      7,
    ]) {
      expect(page(s), JSON.stringify(s)).toBeNull();
    }
  });
});

describe("what the meeting is", () => {
  it("has defaults for malformed members", () => {
    const m = { title: "Blue", seats: 12, epoch: 4, chairs: ["p01", "../x", 3], locked: true, more: 1 };
    expect(readMeeting(toBytes(m))).toEqual({
      title: "Blue",
      seats: 12,
      epoch: 4,
      chairs: ["p01"],
      locked: true,
      more: { more: 1 },
    });
    expect(JSON.parse(new TextDecoder().decode(writeMeeting(readMeeting(toBytes(m))!)))).toEqual({
      v: 1,
      ...m,
      chairs: ["p01"],
    });
    expect(readMeeting(toBytes({ epoch: 0, seats: 1e9 }))).toMatchObject({
      title: "",
      seats: 8,
      locked: false,
    });
    expect(readMeeting(toBytes({ epoch: -1 }))).toBeNull();
  });
});
