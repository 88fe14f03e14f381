// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it, vi } from "vitest";
import { AvatarError } from "../avatar/inspect";
import type { Avatar } from "../avatar/load";
import { Avatars } from "./avatars";
import { useFakePage } from "../shared/testing_dom";

vi.mock("../avatar/store", () => ({
  listAvatars: async () => [],
  putAvatar: async () => ({ id: "1" }),
}));
vi.mock("../shared/graphics", () => ({ drawsInSoftware: () => false }));

useFakePage();
let asked: string[]; // looks of the program
let answers: Map<string, (there: boolean) => void>;
let said: string[];
let remembered: string[];
let avatars: Avatars;

/** The program answers what was asked for. */
async function answer(look: string, there = true): Promise<void> {
  answers.get(look)!(there);
  await vi.waitFor(() => expect(there ? avatars.info?.name : said.at(-1)).toMatch(new RegExp(look, "i")));
}
/** The program sends its list of looks. */
async function start(...looks: string[]): Promise<void> {
  void avatars.setLooks(looks);
  await settle();
}
const settle = () => new Promise((resolve) => setTimeout(resolve, 5));
const file = (text: string) => new File([text], "mine.vrm");

beforeEach(() => {
  vi.useRealTimers();
  asked = [];
  said = [];
  remembered = [];
  answers = new Map();
  vi.stubGlobal("fetch", async (address: string) => {
    const look = /avatars\/(.*)\.vrm/.exec(address)![1]!;
    asked.push(look);
    const ok = await new Promise<boolean>((resolve) => answers.set(look, resolve));
    return { ok, arrayBuffer: async () => new ArrayBuffer(1) };
  });
  avatars = new Avatars(
    {
      load: async (data) => {
        if (new TextDecoder().decode(data) === "bad") throw new AvatarError("This is not a VRM avatar.");
        return { facts: { version: "1", author: "" }, notes: [], dispose: () => {} } as unknown as Avatar;
      },
      show: () => {},
      notify: (_level, words) => said.push(words),
      remember: (id) => remembered.push(id),
    },
    "look:casual",
  );
});

describe("a bad file before anything is shown", () => {
  it("is replaced by the chosen avatar", async () => {
    await start("plain", "casual", "robot");
    void avatars.choose("look:robot");
    void avatars.take(file("bad"));
    await settle();
    expect(said).toEqual(["This is not a VRM avatar."]);
    expect(asked).toEqual(["casual", "robot", "robot"]);
    await answer("robot");
    expect(remembered).toEqual(["look:robot"]);
  });

  it("is replaced by a stored or first avatar", async () => {
    await start("plain", "casual");
    void avatars.take(file("bad"));
    void avatars.take(file("bad")); // one more
    await settle();
    expect(said).toEqual(["This is not a VRM avatar."]);
    expect(asked).toEqual(["casual", "casual"]);
    await answer("casual", false);
    await settle();
    expect(said.at(-1)).not.toMatch(/shown/);
    await answer("plain");
    expect(remembered).toEqual([]);
  });

  it("leaves the first avatar to the program", async () => {
    await avatars.take(file("bad"));
    expect(said).toEqual(["This is not a VRM avatar."]);
    await start("plain", "casual");
    await answer("casual");
  });

  it("is reported when there is no avatar", async () => {
    await avatars.setLooks([]);
    await avatars.take(file("bad"));
    expect(said).toEqual(["This is not a VRM avatar. No avatar is shown."]);
  });
});

describe("a bad file", () => {
  beforeEach(async () => {
    await start("plain", "casual");
    await answer("casual");
  });

  it("keeps the shown avatar", async () => {
    await avatars.take(file("bad"));
    expect(said).toEqual(["This is not a VRM avatar. The avatar stays as it was."]);
    expect(asked).toEqual(["casual"]);
  });

  it("is replaced by one that still loads", async () => {
    void avatars.choose("look:plain");
    void avatars.take(file("bad"));
    await settle();
    expect(said).toEqual(["This is not a VRM avatar."]);
    await answer("plain");
    expect(remembered).toEqual(["look:plain"]);
    await avatars.take(file("bad"));
    expect(said.at(-1)).toMatch(/stays/);
  });
});

describe("a good file", () => {
  it("replaces one that still loads", async () => {
    await start("plain", "casual");
    await avatars.take(file("good"));
    expect(avatars.info?.name).toBe("mine");
    answers.get("casual")!(true);
    await settle();
    expect(avatars.info?.name).toBe("mine");
    await avatars.take(file("bad"));
    expect(said).toEqual(["This is not a VRM avatar. The avatar stays as it was."]);
    expect(remembered).toEqual(["own:1"]);
  });
});
