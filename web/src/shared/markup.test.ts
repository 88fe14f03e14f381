// SPDX-License-Identifier: Apache-2.0
import { expect, it } from "vitest";
import avatarPage from "../../avatar.html?raw";
import livePage from "../../index.html?raw";

it("a canvas with a label has a role", () => {
  for (const page of [livePage, avatarPage]) {
    const labelled = (page.match(/<canvas[^>]*>/g) ?? []).filter((tag) => tag.includes("aria-label"));
    expect(labelled.length).toBeGreaterThan(0);
    for (const tag of labelled) expect(tag).toMatch(/role="(img|application)"/);
  }
});
