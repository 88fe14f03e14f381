// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it, vi } from "vitest";
import type { Command, Phase, Status } from "../live/protocol";
import { Guide } from "./guide";
import { useFakePage } from "../shared/testing_dom";

const element = useFakePage();
let sent: Command[];
let said: string[];
let connected: boolean;
let guide: Guide;

const hasFocus = (id: string): boolean => (document.activeElement as unknown) === element(id);
const enter = (phase: Phase, roomEmpty = false): void =>
  guide.setStatus({ phase, roomEmpty, words: "" } as unknown as Status);

beforeEach(() => {
  sent = [];
  said = [];
  connected = true;
  const send = (c: Command): boolean => {
    if (connected) sent.push(c);
    return connected;
  };
  guide = new Guide(
    send,
    (words) => said.push(words),
    () => {},
  );
});

describe("the guide", () => {
  it("confirms the empty scene after 5 s", () => {
    enter("empty_room");
    element("guide-count").press();
    vi.advanceTimersByTime(4900);
    expect(sent).toEqual([]);
    vi.advanceTimersByTime(200);
    expect(sent).toEqual([{ type: "guide", step: "empty" }]);
  });

  it("stops the countdown when disconnected", () => {
    enter("empty_room");
    element("guide-count").press();
    vi.advanceTimersByTime(2000);
    guide.disconnected();
    expect(element("countdown").hidden).toBe(true);
    expect(element("guide").hidden).toBe(true);
    said = [];
    vi.advanceTimersByTime(60000);
    expect(said).toEqual([]);
    for (const id of ["guide-count", "guide-now", "guide-skip"]) element(id).press();
    vi.advanceTimersByTime(60000);
    expect(sent).toEqual([]);
    enter("empty_room"); // the program is back
    expect(element("guide").hidden).toBe(false);
    element("guide-now").press();
    expect(sent).toEqual([{ type: "guide", step: "empty" }]);
  });

  it("asks to stay out only after confirmation", () => {
    enter("background", true);
    expect(element("guide-text").textContent).toMatch(/Stay out of view/);
    expect(element("guide").dataset.figure).toBe("room");
    enter("background"); // the same title
    expect(element("guide-title").textContent).toBe("Capturing the background");
    expect(element("guide-text").textContent).toMatch(/Stay where you are.*around you/);
    expect(element("guide").dataset.figure).toBe("in");
    expect(said.at(-1)).toMatch(/Stay where you are/);
    enter("background", true);
    expect(element("guide-text").textContent).toMatch(/Stay out of view/);
    enter("person");
    expect(element("guide-title").textContent).toMatch(/Step in/);
  });

  it("is not done for a person found before", () => {
    enter("person");
    guide.disconnected();
    enter("tracking");
    enter("tracking");
    expect(said.join()).not.toMatch(/Done/);
  });

  it("keeps the focus when its buttons go", () => {
    const [box, now, back] = ["guide", "guide-now", "guide-back"].map(element);
    box!.append(now!, back!, element("guide-title"));
    enter("empty_room");
    now!.hidden = false;
    now!.focus();
    now!.hidden = true; // as by the style sheet in the next phase
    enter("background", true);
    expect(hasFocus("guide-title")).toBe(true);
    back!.hidden = false;
    back!.focus();
    enter("person");
    expect(hasFocus("guide-back")).toBe(true);
    back!.hidden = true;
    enter("tracking");
    expect(hasFocus("guide-title")).toBe(true);
    vi.advanceTimersByTime(3000);
    expect(hasFocus("main")).toBe(true);
  });

  it("leaves the focus elsewhere alone", () => {
    element("record").focus();
    enter("empty_room");
    enter("background", true);
    expect(hasFocus("record")).toBe(true);
  });

  it("reports a missing connection", () => {
    enter("empty_room");
    connected = false;
    for (const id of ["guide-now", "guide-skip", "guide-back"]) {
      said = [];
      element(id).press();
      expect(said.join()).toMatch(/no connection/);
    }
    connected = true;
    said = [];
    element("guide-now").press();
    expect(said.join()).not.toMatch(/no connection/);
  });
});
