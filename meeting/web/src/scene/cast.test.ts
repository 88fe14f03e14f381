// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it, vi } from "vitest";
import { AvatarError } from "#web/avatar/inspect";
import type { Avatar } from "#web/avatar/load";
import { useFakePage } from "#web/shared/testing_dom";
import { UnreachableError } from "../avatar_file";
import { toBytes } from "../messages";
import { Roster } from "../roster";
import { TOPIC } from "../testing_meeting";
import { keyOf, type AvatarLibrary } from "./avatar_library";
import { Cast } from "./cast";
import type { Figure } from "./figure";
import type { MeetingStage } from "./meeting_stage";
import type { Tags } from "./tags";

vi.mock("#web/shared/graphics", () => ({ drawsInSoftware: () => false })); // asks the browser
vi.mock("./figure", () => ({
  Figure: class {
    avatar: Avatar | null = null;
    setPlace(): void {}
    setAvatar(avatar: Avatar | null): Avatar | null {
      const before = this.avatar;
      this.avatar = avatar;
      return before;
    }
  } satisfies new () => Pick<Figure, "avatar" | "setAvatar" | "setPlace">,
}));

useFakePage();
/** What each file gives: a name of an avatar, or the reason why there is none. */
let files: Record<string, string | Error>;
let asked: string[];
let cast: Cast;
let roster: Roster;
const wait = (ms: number) => vi.advanceTimersByTimeAsync(ms);

beforeEach(async () => {
  files = { "look:plain": "plain", "look:robot": new UnreachableError("The network is down.") };
  asked = [];
  const library: Pick<AvatarLibrary, "make" | "release"> = {
    make: (choice) => {
      const key = keyOf(choice);
      asked.push(key);
      const file = files[key]!;
      return file instanceof Error ? Promise.reject(file) : Promise.resolve({} as Avatar);
    },
    release: () => {},
  };
  const stage = { add: () => {}, remove: () => {}, touch: () => {} };
  const tags = { set: () => {}, remove: () => {} };
  cast = new Cast(
    stage as unknown as MeetingStage,
    library as AvatarLibrary,
    tags as unknown as Tags,
    { strangers: true, still: false },
    () => {},
  );
  roster = new Roster(TOPIC);
  const state = { session: 5, kind: "browser", name: "Ana", seat: 0, avatar: { look: "robot" } };
  roster.receive(`${TOPIC}/p/p01/presence`, toBytes({ here: true, session: 5 }), 0);
  roster.receive(`${TOPIC}/p/p01/state`, toBytes(state), 0);
});

describe("a participant", () => {
  it("who leaves and joins again and again costs one avatar at a time", async () => {
    for (let i = 0; i < 100; i++) {
      for (const here of [false, true]) {
        roster.receive(`${TOPIC}/p/p01/presence`, toBytes({ here, session: 5 }), 0);
        cast.follow(roster, null);
        await wait(10);
      }
    }
    expect(asked.length).toBeLessThanOrEqual(2);
    await wait(5000);
    expect(cast.dressed("p01")).toBe(true);
  });
});

describe("an avatar that cannot be downloaded", () => {
  it("is tried again after a while", async () => {
    cast.follow(roster, null);
    await wait(3000);
    expect(asked).toEqual(["look:robot", "look:plain"]);
    expect(cast.complaint("p01")).toBe("The network is down.");
    await wait(15000);
    expect(asked).toEqual(["look:robot", "look:plain", "look:robot"]); // its substitute is still there
    expect(cast.dressed("p01")).toBe(true);
    files["look:robot"] = "robot";
    await wait(15000);
    expect(asked.slice(3)).toEqual(["look:robot"]);
    expect(cast.complaint("p01")).toBe("");
    await wait(60000);
    expect(asked.length).toBe(4);
  });
  it("is tried again with a new connection", async () => {
    cast.follow(roster, null);
    await wait(5000);
    files["look:robot"] = "robot";
    cast.retry(roster);
    await wait(0);
    expect(asked).toEqual(["look:robot", "look:plain", "look:robot"]);
    expect(cast.complaint("p01")).toBe("");
  });
  it("is not tried again when it is broken", async () => {
    files["look:robot"] = new AvatarError("The file is broken.");
    cast.follow(roster, null);
    await wait(60000);
    cast.retry(roster);
    await wait(1000);
    expect(asked).toEqual(["look:robot", "look:plain"]);
    expect(cast.complaint("p01")).toBe("The file is broken.");
  });
  it("is not tried again after leaving", async () => {
    cast.follow(roster, null);
    await wait(100);
    cast.clear();
    await wait(60000);
    expect(asked).toEqual(["look:robot"]);
  });
});
