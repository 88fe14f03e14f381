// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { AT_ONCE, ChatLog, MOST_LINES, Outbox } from "./chat";
import { LIMITS, readChat } from "./messages";

const receive = (log: ChatLog, from: string, n: number, now: number, text = "hi") =>
  log.receive(from, from, { id: `1-${n}`, text }, false, now);

describe("the chat", () => {
  it("shows each message once", () => {
    const log = new ChatLog();
    expect(receive(log, "p01", 1, 0)).not.toBeNull();
    expect(receive(log, "p01", 1, 1)).toBeNull();
    expect(receive(log, "p02", 1, 1)).not.toBeNull();
    expect(log.lines.length).toBe(2);
  });
  it("limits the rate of each participant", () => {
    const log = new ChatLog();
    for (let i = 0; i < 500; i++) receive(log, "p01", i, 0);
    expect(log.lines.length).toBe(AT_ONCE);
    expect(log.flooded).toBe(500 - AT_ONCE);
    expect(receive(log, "p02", 1, 0)).not.toBeNull();
    expect(receive(log, "p01", 501, 3)).not.toBeNull();
  });
  it("has a limited length", () => {
    const log = new ChatLog();
    for (let i = 0; i < 5000; i++) receive(log, "p01", i, i * 2);
    expect(log.lines.length).toBe(MOST_LINES);
    log.note("Ana joined.");
    expect(log.lines.at(-1)).toMatchObject({ kind: "note", text: "Ana joined." });
    expect(log.lines.length).toBe(MOST_LINES);
  });
  it("keeps markup as text, drops empty lines", () => {
    const log = new ChatLog();
    const text = '<img src=x onerror="alert(1)">';
    expect(receive(log, "p01", 1, 0, text)).toMatchObject({ text });
    expect(receive(log, "p01", 2, 0, " \u200b ")).toBeNull();
  });
});

describe("an outgoing message", () => {
  it("waits until the broker has it", () => {
    const out = new Outbox(77);
    expect(out.add("  hello ")).toEqual({ id: "77-1", text: "hello" });
    expect(out.add("again")).toMatchObject({ id: "77-2" });
    expect(out.waiting.map((m) => readChat(m.bytes)!.text)).toEqual(["hello", "again"]);
    out.done("77-1");
    out.done("77-1");
    expect(out.waiting.map((m) => m.id)).toEqual(["77-2"]);
  });
  it("is sent no faster than others accept", () => {
    const [out, log] = [new Outbox(1), new ChatLog()];
    for (let n = 0, t = 0; n < 100; t += 0.1) {
      if (!out.mayGo(t)) continue;
      // Some take up to a second longer.
      expect(receive(log, "p01", n++, t + (n % 2 ? 1 : 0))).not.toBeNull();
    }
  });
  it("is refused if too long or too many wait", () => {
    const out = new Outbox(1);
    expect(out.add("")).toBe("");
    expect(out.add("x".repeat(501))).toContain("501 characters");
    expect(out.add('"'.repeat(500))).toMatchObject({ id: "1-1" });
    expect(out.waiting.every((m) => m.bytes.length <= LIMITS.chat)).toBe(true);
    expect(out.add("😀".repeat(500))).toMatchObject({ id: "1-2" });
    expect(out.add("\u0001".repeat(500))).toBe("This message is too long.");
    for (let i = 0; i < 18; i++) out.add("x");
    expect(out.add("x")).toContain("waiting");
  });
});
