// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it } from "vitest";
import { Shortcuts } from "./shortcuts";
import { useFakePage } from "./testing_dom";

useFakePage();
let ran: string[];
let press: (key: string, shiftKey?: boolean) => void;

beforeEach(() => {
  ran = [];
  Object.assign(document, {
    addEventListener: (_: string, then: (e: unknown) => void) => {
      press = (key, shiftKey = false) => then({ key, shiftKey, target: null, preventDefault: () => {} });
    },
  });
  const list = ["m", "M", "r", "1"].map((key) => ({ key, label: key, run: () => ran.push(key) }));
  new Shortcuts(list, { keys: true }, () => {}, []);
});

describe("shortcuts", () => {
  it("tell small letters from capitals", () => {
    press("m");
    press("M", true);
    press("R", true); // nothing
    expect(ran).toEqual(["m", "M"]);
  });
  it("are the same with Caps Lock", () => {
    press("M");
    press("m", true);
    press("R");
    expect(ran).toEqual(["m", "M", "r"]);
  });
  it("take digits with and without Shift", () => {
    press("1");
    press("1", true);
    expect(ran).toEqual(["1", "1"]);
  });
});
