// SPDX-License-Identifier: Apache-2.0
import { expect, test } from "vitest";
import { readOptions } from "./options";

const read = (query: string) => readOptions(`http://localhost:7070/avatar${query}`);

test("without options the first avatar on a transparent ground", () => {
  expect(read("")).toEqual({
    options: {
      avatar: null,
      framing: "bust",
      width: null,
      height: null,
      background: "transparent",
      mirror: false,
      debug: false,
    },
    mistakes: [],
  });
});

test("all options", () => {
  const { options, mistakes } = read(
    "?avatar=robot&framing=head&width=640&height=480&background=green&mirror=1&debug",
  );
  expect(mistakes).toEqual([]);
  expect(options).toEqual({
    avatar: "robot",
    framing: "head",
    width: 640,
    height: 480,
    background: "#00ff00",
    mirror: true,
    debug: true,
  });
});

test("a colour with or without its sign, also before other options", () => {
  for (const colour of ["#20A060", "20A060", "%2320A060"]) {
    const { options, mistakes } = read(`?background=${colour}&framing=full`);
    expect(mistakes).toEqual([]);
    expect([options.background, options.framing]).toEqual(["#20A060", "full"]);
  }
});

test("an avatar by its address", () => {
  const avatar = (value: string) => String(read(`?avatar=${encodeURIComponent(value)}`).options.avatar);
  expect(avatar("https://example.org/a/me.vrm?v=1")).toBe("https://example.org/a/me.vrm?v=1");
  expect(avatar("/avatars/robot.vrm")).toBe("http://localhost:7070/avatars/robot.vrm");
});

test.each([
  ["?fram=head", 'There is no option "fram". The options are avatar, framing,'],
  ["?framing=feet", '"framing" cannot be "feet": it is one of bust, head, full.'],
  ["?width=5", '"width" cannot be "5": it is a number of pixels from 16 to 7680.'],
  ["?height=1e3", '"height" cannot be "1e3"'],
  ["?background=red", "transparent, green or a colour like #20a060"],
  ["?background=", '"background" cannot be ""'],
  ["?mirror=yes", '"mirror" cannot be "yes": it is one of 0, 1.'],
  ["?avatar=", '"avatar" cannot be ""'],
  ["?avatar=file:///etc/me.vrm", "the address (http or https) of a VRM file"],
  ["?avatar=javascript:x.y", '"avatar" cannot be'],
])("%s is a mistake", (query, words) => {
  const { mistakes } = read(query);
  expect(mistakes).toHaveLength(1);
  expect(mistakes[0]).toContain(words);
});
