// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it, vi } from "vitest";
import { Panel } from "./panel";
import { FakeElement, useFakePage } from "./testing_dom";

const element = useFakePage();
let panel: Panel<{ panelClosed: boolean; tab: string }>;
let wide: { matches: boolean; addEventListener: (type: string, then: () => void) => void };
let resized: () => void;
/** Whether the panel was visible at each call of `save`. */
let saved: boolean[];

beforeEach(() => {
  wide = { matches: true, addEventListener: (_, then) => (resized = then) };
  vi.stubGlobal("matchMedia", () => wide);
  const tab = new FakeElement();
  tab.dataset.tab = "chat";
  tab.setAttribute("role", "tab");
  tab.setAttribute("aria-controls", "page-chat");
  const tabs = new FakeElement();
  tabs.setAttribute("role", "tablist");
  tabs.append(tab);
  element("panel").append(tabs);
  saved = [];
  panel = new Panel({ panelClosed: true, tab: "chat" }, () =>
    saved.push(document.body.dataset.panel === "open"),
  );
  saved.length = 0;
});

describe("the side panel", () => {
  it("is saved as it is seen", () => {
    panel.toggle();
    panel.toggle();
    expect(saved).toEqual([true, false]);
  });
  it("is saved also over a narrow page", () => {
    wide.matches = false;
    panel.toggle();
    panel.toggle();
    panel.toggle();
    wide.matches = true;
    resized();
    expect(saved).toEqual([true, false, true, false]);
  });
});
