// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import type { Entered } from "./entry";
import { trackerCommand } from "./tracker_command";

const entered: Entered = {
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
    const url = address(trackerCommand(entered, me));
    expect([url.protocol, url.host, url.pathname]).toEqual(["mqtt:", "localhost:1883", "/lab/main"]);
    expect([url.username, url.password].map(decodeURIComponent)).toEqual([entered.user, entered.password]);
    expect(Object.fromEntries(url.searchParams)).toEqual({ name: "Jörg's", look: "robot", seat: "2" });
  });
  it("names the participant if necessary", () => {
    const url = address(trackerCommand({ ...entered, user: "ana" }, { ...me, avatar: null, seat: null }));
    expect(Object.fromEntries(url.searchParams)).toEqual({ name: "Jörg's", participant: "p03" });
  });
  it("uses TLS where the broker does", () => {
    const url = address(trackerCommand({ ...entered, tcp: "mqtts://[::1]:8883" }, me));
    expect([url.protocol, url.host]).toEqual(["mqtts:", "[::1]:8883"]);
  });
  it("is null for watchers and without TCP", () => {
    expect(trackerCommand({ ...entered, participant: null }, null)).toBeNull();
    expect(trackerCommand({ ...entered, tcp: null }, me)).toBeNull();
    expect(trackerCommand(entered, null)).toBeNull();
  });
});
