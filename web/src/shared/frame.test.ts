// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { buildFrame } from "./frame";
import { FakeElement, useFakePage } from "./testing_dom";

describe("the frame of a page", () => {
  useFakePage();
  it("has tabs alone in the list of tabs", () => {
    const pages = ["avatar", "send"].map((tab) => Object.assign(new FakeElement(), { dataset: { tab } }));
    const find = (selector: string) => (selector === ".tab-page" ? pages : []);
    Object.assign(document, { querySelectorAll: find });
    buildFrame({ state: "", note: "" });
    const body = document.body as unknown as FakeElement;
    const [list] = body.querySelectorAll("[role]").filter((e) => e.getAttribute("role") === "tablist");
    expect(list!.children.map((e) => e.getAttribute("role"))).toEqual(["tab", "tab"]);
    const bar = body.querySelectorAll("[class]").find((e) => e.getAttribute("class") === "tabs")!;
    expect(bar.children.map((e) => e.getAttribute("id"))).toEqual([null, "panel-close"]);
    expect(bar.children[0]).toBe(list);
  });
});
