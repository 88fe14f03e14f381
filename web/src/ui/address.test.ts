// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { withoutPassword } from "./address";

describe("an address as the program shows it", () => {
  // The cases of url_test.cpp.
  it("has no password", () => {
    expect(withoutPassword("x://a:secret@h:1/p?q=1")).toBe("x://a@h:1/p?q=1");
    for (const url of [
      "x://a:secret@h",
      "x://a:secret@h:1:2",
      "x://a:sec@secret@h",
      "x://a:x/secret@h/p/q",
      "x://a:x?secret@h/p",
      "mqtt://a:1/secret@h/p/q",
      "mqtt://a:secret@h/p?n=b@c",
      "MQTT://a:12?secret@h",
      "x://:secret@h",
      "mqtt://a:x#secret@h",
    ]) {
      expect(withoutPassword(url)).not.toContain("secret");
    }
  });
  it("has no secret of a room", () => {
    expect(withoutPassword("https://h/room#k=secret")).toBe("https://h/room");
    expect(withoutPassword("HTTP://h:7080/room?name=Ana#secret")).toBe("HTTP://h:7080/room?name=Ana");
  });
  it("is else as it was given", () => {
    for (const url of [
      "x://a@h:1/p",
      "x://h:1/p?q=a@b",
      "x://[::1]:80/p",
      "no URL",
      "https://h/room",
      "vmc://localhost:39539",
    ]) {
      expect(withoutPassword(url)).toBe(url);
    }
  });
});
