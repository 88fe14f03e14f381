// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it, vi } from "vitest";
import { PoseDriver } from "../avatar/driver";
import type { StageOptions } from "../avatar/stage";
import { NoWebGl } from "../shared/graphics";
import { useFakePage } from "../shared/testing_dom";
import { Loop } from "./loop";

const fake = vi.hoisted(() => ({ failure: new Error() }));
vi.mock("../avatar/stage", () => ({
  Stage: class {
    constructor() {
      throw fake.failure;
    }
  },
}));

/** What the page says when the stage fails in this way. */
async function complaint(failure: Error, options: StageOptions = {}): Promise<string> {
  fake.failure = failure;
  return new Promise((complain) => new Loop(new PoseDriver(), [], () => true, complain, options));
}

describe("a stage that fails", () => {
  useFakePage();
  it("is explained where WebGL is off", async () => {
    const why = "The avatar cannot be shown: WebGL is off in this browser.";
    expect(await complaint(new NoWebGl())).toBe(`${why} Everything else works.`);
    expect(await complaint(new NoWebGl(), { alone: true })).toBe(why);
  });
  it("is not blamed on WebGL for other reasons", async () => {
    const words = await complaint(new RangeError("odd"));
    expect(words).toContain("RangeError: odd. Reload the page.");
    expect(words).not.toContain("WebGL");
  });
});
