// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it, vi } from "vitest";
import type { Command, Output } from "../live/protocol";
import { OutputList, withoutPassword } from "./outputs";
import { useFakePage } from "../shared/testing_dom";

const element = useFakePage();
let outputs: OutputList;
let sent: Command[];
let warned: string[];
let connected: boolean;

const output = (url: string, state = "sending"): Output => ({
  url,
  state,
  words: "",
  sent: 7,
  dropped: 0,
  receivers: 1,
});
const listed = (): string => element("outputs").textContent;
const complaint = (): string => element("output-error").textContent;
const input = (): string => element("output-url").value;
function add(url: string): void {
  element("output-url").value = url;
  element("output-form").dispatch("submit");
}

beforeEach(() => {
  sent = [];
  connected = true;
  warned = [];
  outputs = new OutputList(
    (c) => {
      if (connected) sent.push(c);
      return connected;
    },
    (words) => warned.push(words),
  );
  outputs.setOutputs([]);
});

describe("an added address", () => {
  it("gets only the error that names it", () => {
    add("mqtt://ana:secret@host/Home");
    expect(input()).toBe("");
    expect(outputs.refused("the recording was ended: No space left on device")).toBe(false);
    expect(complaint()).toBe("");
    expect(outputs.refused('the output "mqtt://ana@host/Home" does not name a room')).toBe(true);
    expect(complaint()).toMatch(/does not name a room/);
    expect(input()).toBe("mqtt://ana:secret@host/Home");
    expect(outputs.refused('the output "mqtt://ana@host/Home" does not name a room')).toBe(false);
  });

  it("is answered by the list of outputs", () => {
    for (const [given, shown] of [
      ["vmc://localhost", "vmc://localhost"],
      ["mqtt://ana:secret@host/home/studio", "mqtt://ana@host/home/studio"],
      ["http://host:7080/room#k=secret", "http://host:7080/room"],
    ] as const) {
      add(given);
      outputs.setOutputs([output(shown, "connecting")]);
      expect(outputs.refused(`something later about ${shown}`)).toBe(false);
      outputs.setOutputs([]);
    }
  });

  it("that is already listed gets its error", () => {
    outputs.setOutputs([output("vmc://localhost")]);
    add("vmc://localhost");
    outputs.setOutputs([output("vmc://localhost")]);
    expect(outputs.refused("vmc://localhost is sent to already")).toBe(true);
    outputs.setOutputs([output("vmc://localhost", "off")]);
    add("vmc://localhost");
    outputs.setOutputs([output("vmc://localhost", "off")]); // on its way before
    outputs.setOutputs([output("vmc://localhost", "connecting")]);
    expect(outputs.refused("vmc://localhost is not among the outputs")).toBe(false);
  });

  it("does not wait for long", () => {
    add("vmc://localhost");
    vi.advanceTimersByTime(3100);
    expect(outputs.refused('the output "vmc://localhost" is odd')).toBe(false);
  });

  it("that is malformed is not sent", () => {
    add("localhost");
    expect(complaint()).toMatch(/looks like/);
    add(`vmc://${"a".repeat(2000)}`);
    expect(complaint()).toMatch(/2000/);
    expect(sent).toEqual([]);
  });
});

describe("an output that fails", () => {
  const url = "vmc://localhost";
  const states = (...all: string[]): void => {
    for (const state of all) {
      vi.advanceTimersByTime(500);
      outputs.setOutputs([output(url, state), output("ws://b")]);
    }
  };
  const count = (): string => element("count-send").textContent;

  it("is reported once, and marked", () => {
    states("connecting", "sending");
    expect([count(), warned.length]).toEqual(["2", 0]);
    for (let i = 0; i < 10; i++) states("failed", "sending"); // tried again and again
    expect(count()).toBe("2 !");
    expect(element("count-send").classes.has("bad")).toBe(true);
    expect(warned).toEqual(["vmc://localhost: failed."]);
  });
  it("is reported again after a recovery", () => {
    states("failed", ...Array<string>(22).fill("sending"));
    expect(count()).toBe("2");
    expect(element("count-send").classes.has("bad")).toBe(false);
    states("failed", "off");
    expect([count(), warned.length]).toEqual(["2", 2]);
    states("failed");
    outputs.setOutputs([output("ws://b")]); // removed
    expect([count(), warned.length]).toEqual(["1", 3]);
  });
});

describe("outputs without a connection", () => {
  it("have no state and report the reason", () => {
    outputs.setOutputs([output("vmc://localhost")]);
    expect(listed()).toMatch(/sending.*7 sent/);
    outputs.disconnected();
    expect(listed()).toMatch(/vmc:\/\/localhostnot connected/);
    expect(listed()).not.toMatch(/sending|7 sent/);
    const row = element("outputs").children[0]!;
    expect(row.children[0]!.getAttribute("class")).toBe("dot");
    connected = false;
    row.children.at(-1)!.press();
    expect(complaint()).toMatch(/no connection/);
    outputs.setOutputs([output("vmc://localhost")]);
    expect(listed()).toMatch(/sending.*7 sent/);
    expect(complaint()).toBe("");
  });
});

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
