// SPDX-License-Identifier: Apache-2.0
import { sha256 } from "@noble/hashes/sha2";
import { bytesToHex } from "@noble/hashes/utils";
import { describe, expect, it } from "vitest";
import { STRANGERS } from "./bounds";
import { AvatarError } from "#web/avatar/inspect";
import { glbFile, vrm1 } from "#web/avatar/testing_file";
import { UnreachableError, describeFile, ownLook, strangersFile } from "./avatar_file";
import { MAX_AVATAR } from "./messages";

const URL_ = "https://example.org/a.vrm";
const DATA = glbFile(vrm1());
const FILE = { url: URL_, sha256: bytesToHex(sha256(DATA)), bytes: DATA.length };
const giving =
  (data: Uint8Array<ArrayBuffer>, init?: ResponseInit): typeof fetch =>
  () =>
    Promise.resolve(new Response(data, init));

describe("a participant's file", () => {
  it("is accepted with its hash and size", async () => {
    const got = await strangersFile(FILE, STRANGERS, giving(DATA));
    expect(new Uint8Array(got)).toEqual(DATA);
  });
  it("is refused when it differs", async () => {
    const changed = DATA.slice();
    changed[40]! ^= 1;
    const refused = "changed since its owner chose it";
    await expect(strangersFile(FILE, STRANGERS, giving(changed))).rejects.toThrow(refused);
    await expect(strangersFile(FILE, STRANGERS, giving(DATA.slice(1)))).rejects.toThrow(refused);
    const noise = Uint8Array.from([1, 2, 3]);
    await expect(strangersFile(FILE, STRANGERS, giving(noise))).rejects.toThrow(refused);
  });
  it("that never ends is not read further", async () => {
    let given = 0;
    const endless = new ReadableStream<Uint8Array>({
      pull(c) {
        given += 1 << 16;
        c.enqueue(new Uint8Array(1 << 16));
      },
    });
    const fetcher: typeof fetch = () => Promise.resolve(new Response(endless));
    await expect(strangersFile(FILE, STRANGERS, fetcher)).rejects.toThrow("larger than announced");
    expect(given).toBeLessThan(1 << 20);
    const headers = { "content-length": String(MAX_AVATAR + 1) };
    await expect(describeFile(URL_, giving(DATA, { headers }))).rejects.toThrow("64 MB");
  });
  it("is inspected although its hash is right", async () => {
    const noise = new Uint8Array(100);
    const file = { url: URL_, sha256: bytesToHex(sha256(noise)), bytes: 100 };
    await expect(strangersFile(file, STRANGERS, giving(noise))).rejects.toThrow("not a VRM avatar");
    await expect(strangersFile(FILE, { ...STRANGERS, nodes: 3 }, giving(DATA))).rejects.toThrow("too large");
  });
  it("is fetched without credentials", async () => {
    let init: RequestInit | undefined;
    const fetcher: typeof fetch = (_, i) => {
      init = i;
      return Promise.resolve(new Response(DATA));
    };
    await strangersFile(FILE, STRANGERS, fetcher);
    expect(init).toMatchObject({ credentials: "omit", referrerPolicy: "no-referrer" });
  });
  it("that cannot be loaded gives the reason", async () => {
    await expect(strangersFile(FILE, STRANGERS, giving(DATA, { status: 404 }))).rejects.toThrow(
      "example.org does not have",
    );
    const broken: typeof fetch = () => Promise.reject(new TypeError("Failed to fetch"));
    await expect(strangersFile(FILE, STRANGERS, broken)).rejects.toThrow("CORS");
    const elsewhere: typeof fetch = () => {
      const answer = new Response(DATA);
      Object.defineProperty(answer, "url", { value: "http://example.org/a.vrm" });
      return Promise.resolve(answer);
    };
    await expect(strangersFile(FILE, STRANGERS, elsewhere)).rejects.toBeInstanceOf(AvatarError);
  });
});

describe("an avatar that may be there later", () => {
  it("is distinguished from one that is not", async () => {
    const reasons = (fetcher: typeof fetch) =>
      Promise.all(
        [strangersFile(FILE, STRANGERS, fetcher), ownLook("plain", false, fetcher)].map((file) =>
          file.catch((e: unknown) => e),
        ),
      );
    const torn = () => new ReadableStream({ start: (c) => c.error(new TypeError("network error")) });
    for (const passing of [
      () => Promise.reject(new TypeError("Failed to fetch")),
      () => Promise.resolve(new Response(torn())),
      giving(DATA, { status: 503 }),
    ])
      for (const e of await reasons(passing)) expect(e).toBeInstanceOf(UnreachableError);
    for (const e of await reasons(giving(DATA, { status: 404 }))) {
      expect(e).toBeInstanceOf(AvatarError);
      expect(e).not.toBeInstanceOf(UnreachableError);
    }
  });
});

describe("the user's own choice", () => {
  it("is described for the others", async () => {
    expect(await describeFile(` ${URL_} `, giving(DATA))).toEqual(FILE);
    for (const address of ["http://example.org/a.vrm", "a.vrm", "", "https://u:p@example.org/a.vrm"]) {
      await expect(describeFile(address, giving(DATA))).rejects.toThrow("https://");
    }
  });
  it("of the meeting's own has a light form", async () => {
    const asked: string[] = [];
    const fetcher: typeof fetch = (url) => {
      asked.push(String(url));
      return Promise.resolve(new Response(DATA));
    };
    await ownLook("plain", false, fetcher);
    await ownLook("plain", true, fetcher);
    expect(asked).toEqual(["/avatars/plain.vrm", "/avatars/plain-light.vrm"]);
    await expect(ownLook("x", false, giving(DATA, { status: 404 }))).rejects.toThrow('"x"');
  });
});
