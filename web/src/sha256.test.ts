// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { sha256, sha256Hex } from "./sha256";

const of = (text: string): string => sha256Hex(new TextEncoder().encode(text));

describe("SHA-256", () => {
  it("of the examples of the standard", () => {
    expect(of("")).toBe("e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    expect(of("abc")).toBe("ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    expect(of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")).toBe(
      "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1",
    );
  });
  it("is the platform's at any length", async () => {
    for (let n = 0; n < 200; n++) {
      const data = Uint8Array.from({ length: n }, (_, i) => (i * 31 + n) & 255);
      expect(sha256Hex(data)).toBe(await sha256(data));
    }
  });
  it("of a part of memory", () => {
    const all = new TextEncoder().encode("..abc..");
    expect(sha256Hex(all.subarray(2, 5))).toBe(of("abc"));
  });
});
