// SPDX-License-Identifier: Apache-2.0
import { afterEach, describe, expect, it, vi } from "vitest";
import {
  EntryError,
  LOOKS,
  enter,
  enterStored,
  inviteOf,
  inviteOfTab,
  readEntered,
  readSaved,
  storedEntry,
  tokenFor,
  withSeat,
  trackerCommand,
  untilAnswered,
  type Entered,
} from "./entry";

const ANSWER = {
  user: "main.p01",
  password: "secret",
  participant: "p01",
  mqtt: "ws://localhost:9001",
  topic: "r/lab/main",
  roles: ["speak", "board"],
  return: "token-1",
};

/** A browser's storage. */
const storage = () => {
  const kept = new Map<string, string>();
  return {
    getItem: (key: string) => kept.get(key) ?? null,
    setItem: (key: string, value: string) => void kept.set(key, value),
  };
};
afterEach(() => vi.unstubAllGlobals());

describe("a link", () => {
  it("has its secret behind #", () => {
    expect(inviteOf("#k=abc_DEF-123")).toBe("abc_DEF-123");
    expect(inviteOf("#x=1&k=abc")).toBe("abc");
    for (const f of ["", "#", "#k=", "#abc", `#k=${"x".repeat(201)}`, "#k=<script>"]) {
      expect(inviteOf(f)).toBeNull();
    }
  });
  it("is known to its tab after a reload", () => {
    vi.stubGlobal("sessionStorage", storage());
    expect(inviteOfTab(null)).toBeNull();
    expect(inviteOfTab("abc")).toBe("abc");
    expect(inviteOfTab(null)).toBe("abc");
    expect(inviteOfTab("def")).toBe("def");
    expect(inviteOfTab(null)).toBe("def");
    vi.stubGlobal("sessionStorage", undefined);
    expect(inviteOfTab("abc")).toBe("abc");
    expect(inviteOfTab(null)).toBeNull();
  });
});

describe("the answer", () => {
  it("is read completely", () => {
    expect(readEntered(ANSWER)).toEqual({
      user: "main.p01",
      password: "secret",
      participant: "p01",
      mqtt: "ws://localhost:9001/",
      tcp: null,
      topic: "r/lab/main",
      roles: ["speak", "board"],
      token: "token-1",
      looks: LOOKS,
    });
  });
  it("may lead to a broker below a path", () => {
    const url = "wss://room.example.org/mqtt";
    expect(readEntered({ ...ANSWER, mqtt: url })!.mqtt).toBe(url);
  });
  it("may name the broker for programs", () => {
    const tcp = (v: unknown) => readEntered({ ...ANSWER, tcp: v })!.tcp;
    for (const good of ["mqtt://localhost:1883", "mqtts://room.example.org:8883", "mqtt://[::1]:1883"])
      expect(tcp(good)).toBe(good);
    expect(tcp("mqtt://localhost:1883/")).toBe("mqtt://localhost:1883");
    for (const bad of [
      7,
      "",
      "http://h:1",
      "mqtt://u:p@h:1",
      "mqtt://h:1/x",
      "mqtt://h';rm -r '",
      "mqtt://$(x):1",
    ])
      expect(tcp(bad)).toBeNull();
  });
  it("for watchers has no participant", () => {
    expect(readEntered({ ...ANSWER, roles: ["watch"] })!.participant).toBeNull();
    expect(readEntered({ ...ANSWER, participant: null })!.participant).toBeNull();
  });
  it("that lacks something is refused", () => {
    for (const change of [
      { mqtt: "http://localhost:9001" },
      { mqtt: "javascript:1" },
      { topic: "r/lab/#" },
      { topic: "x" },
      { user: "" },
      { password: 7 },
    ]) {
      expect(readEntered({ ...ANSWER, ...change })).toBeNull();
    }
    for (const a of [null, 3, "x", []]) expect(readEntered(a)).toBeNull();
    expect(readEntered({ ...ANSWER, looks: ["a", "../b", 3] })!.looks).toEqual(["a"]);
  });
});

describe("entering", () => {
  const answering =
    (status: number, body: unknown, seen: Request[] = []) =>
    (url: RequestInfo | URL, init?: RequestInit): Promise<Response> => {
      seen.push(new Request(new URL(String(url), "http://localhost"), init));
      return Promise.resolve(new Response(JSON.stringify(body), { status }));
    };
  const question = { invite: "SECRET", token: null, watch: false };

  it("sends the secret in the body alone", async () => {
    const seen: Request[] = [];
    const entered = await enter({ ...question, token: "t" }, answering(200, ANSWER, seen));
    expect(entered.user).toBe("main.p01");
    expect(seen[0]!.url).toBe("http://localhost/room/enter");
    expect(seen[0]!.method).toBe("POST");
    expect(await seen[0]!.json()).toEqual({ v: 1, invite: "SECRET", return: "t", watch: false });
  });
  it("gives the reason without the secret", async () => {
    for (const [status, words] of [
      [403, "not valid"],
      [409, "seats"],
      [423, "locked"],
      [429, "Too many"],
      [500, "refused the request"],
      [502, "refused the request"],
    ] as const) {
      const e = await enter(question, answering(status, { error: "SECRET" })).catch((x: unknown) => x);
      expect(e).toBeInstanceOf(EntryError);
      expect((e as Error).message).toContain(words);
      expect((e as Error).message).not.toContain("SECRET");
      expect((e as EntryError).final).toBe(status !== 429 && status < 500);
    }
    await expect(enter(question, answering(200, {}))).rejects.toThrow("does not understand");
    await expect(enter(question, () => Promise.reject(new TypeError("net")))).rejects.toThrow("answer");
  });
});

describe("asking until there is an answer", () => {
  const outcome = async (failures: Error[], most = 10) => {
    const pauses: number[] = [];
    const ask = () => {
      const e = failures.shift();
      return e ? Promise.reject(e) : Promise.resolve("entered");
    };
    const pause = (n: number) => Promise.resolve(pauses.push(n) < most);
    const answer = await untilAnswered(ask, pause).catch((e: unknown) => (e as Error).message);
    return { answer, pauses };
  };
  it("repeats what may succeed later, and only that", async () => {
    const busy = () => new EntryError("busy");
    expect(await outcome([busy(), busy()])).toEqual({ answer: "entered", pauses: [0, 1] });
    expect(await outcome([busy(), new EntryError("locked", true)])).toEqual({
      answer: "locked",
      pauses: [0],
    });
    expect(await outcome([new TypeError("a defect")])).toEqual({ answer: "a defect", pauses: [] });
    expect(await outcome([busy(), busy(), busy()], 2)).toEqual({ answer: "busy", pauses: [0, 1] });
  });
});

describe("what the browser stores", () => {
  const entered = readEntered(ANSWER)!;
  const by = (invite: string | null, token: string | null = null) => ({ invite, token, watch: false });
  it("leads to the seat of a link, or the last", () => {
    let saved = readSaved(null);
    expect(tokenFor(saved, "A")).toBeNull();
    saved = withSeat(saved, by("A"), entered);
    saved = withSeat(saved, by("B"), { ...entered, token: "token-2", topic: "r/lab/two" });
    expect([tokenFor(saved, "A"), tokenFor(saved, "B"), tokenFor(saved, "C")]).toEqual([
      "token-1",
      "token-2",
      null,
    ]);
    expect(tokenFor(saved, null)).toBe("token-2");
    saved = withSeat(saved, by(null, "token-1"), { ...entered, token: "token-3" }); // back without the link
    expect(tokenFor(saved, "A")).toBe("token-3");
    expect(readSaved(JSON.stringify(saved))).toEqual(saved);
  });
  it("keeps the seats of two links to a meeting", () => {
    let saved = withSeat(readSaved(null), by("CHAIR"), entered);
    saved = withSeat(saved, by("SPEAK"), { ...entered, token: "token-2" });
    saved = withSeat(saved, by(null, "token-2"), { ...entered, token: "token-3" });
    expect([tokenFor(saved, "CHAIR"), tokenFor(saved, "SPEAK")]).toEqual(["token-1", "token-3"]);
  });
  it("keeps the seats of two tabs", async () => {
    vi.stubGlobal("localStorage", storage());
    const giving = (token: string) => () =>
      Promise.resolve(new Response(JSON.stringify({ ...ANSWER, return: token })));
    const tabs = [storedEntry(), storedEntry()] as const;
    await Promise.all([
      enterStored(tabs[0], by("CHAIR"), giving("token-1")),
      enterStored(tabs[1], by("SPEAK"), giving("token-2")),
    ]);
    const saved = storedEntry().load();
    expect([tokenFor(saved, "CHAIR"), tokenFor(saved, "SPEAK")]).toEqual(["token-1", "token-2"]);
  });
  it("does not contain the secret", () => {
    expect(JSON.stringify(withSeat(readSaved(null), by("VERYSECRET"), entered))).not.toContain("VERYSECRET");
  });
  it("is bounded, and empty when malformed", () => {
    let saved = readSaved(null);
    for (let i = 0; i < 50; i++) saved = withSeat(saved, by(`link${i}`), { ...entered, token: `t${i}` });
    expect(saved.seats.length).toBe(10);
    for (const t of [
      "{",
      "3",
      "null",
      '{"seats":3,"name":7,"avatar":{}}',
      '{"seats":[null,{"topic":"x"}]}',
    ]) {
      expect(readSaved(t)).toEqual({ seats: [], name: "", avatar: "" });
    }
  });
});

const SEATED: Entered = {
  user: "main.p03",
  password: "a'b:c/@d!",
  participant: "p03",
  mqtt: "ws://localhost:9001/",
  tcp: "mqtt://localhost:1883",
  topic: "r/lab/main",
  roles: ["speak"],
  token: null,
  looks: [],
};
const me = { name: "Jörg's", avatar: { look: "robot" }, seat: 2 };

/** The address in the command, which must be one word of a shell's. */
const address = (command: string | null): URL => {
  const found = /^telemime live --send '([^'\s\\]+)'$/.exec(command ?? "");
  expect(found, command ?? "none").not.toBeNull();
  return new URL(found![1]!);
};

describe("the command for one's tracker", () => {
  it("contains account, meeting and look", () => {
    const url = address(trackerCommand(SEATED, me));
    expect([url.protocol, url.host, url.pathname]).toEqual(["mqtt:", "localhost:1883", "/lab/main"]);
    expect([url.username, url.password].map(decodeURIComponent)).toEqual([SEATED.user, SEATED.password]);
    expect(Object.fromEntries(url.searchParams)).toEqual({ name: "Jörg's", look: "robot", seat: "2" });
  });
  it("names the participant if necessary", () => {
    const url = address(trackerCommand({ ...SEATED, user: "ana" }, { ...me, avatar: null, seat: null }));
    expect(Object.fromEntries(url.searchParams)).toEqual({ name: "Jörg's", participant: "p03" });
  });
  it("uses TLS where the broker does", () => {
    const url = address(trackerCommand({ ...SEATED, tcp: "mqtts://[::1]:8883" }, me));
    expect([url.protocol, url.host]).toEqual(["mqtts:", "[::1]:8883"]);
  });
  it("is null for watchers and without TCP", () => {
    expect(trackerCommand({ ...SEATED, participant: null }, null)).toBeNull();
    expect(trackerCommand({ ...SEATED, tcp: null }, me)).toBeNull();
    expect(trackerCommand(SEATED, null)).toBeNull();
  });
});
