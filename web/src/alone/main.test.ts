// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it, vi } from "vitest";
import type { Listener } from "../live/connection";
import type { Debug } from "../live/debug";
import { PROTOCOL } from "../live/protocol";
import { useFakePage } from "../shared/testing_dom";

const fake = vi.hoisted(() => ({
  webgl: true,
  listener: null as Listener | null,
  debug: null as Debug | null,
  built: 0,
}));

vi.mock("../avatar/stage", () => ({
  Stage: class {
    readonly painter = { software: false };
    constructor() {
      fake.built++;
      if (!fake.webgl) throw new Error("no WebGL");
    }
    setAvatar(): void {}
  },
}));
vi.mock("../avatar/fetch", () => ({
  fromProgram: (name: string) => Promise.resolve({ name, data: new ArrayBuffer(0) }),
}));
vi.mock("../avatar/load", () => ({
  loadAvatar: () => Promise.resolve({ facts: { version: "1", author: "" }, notes: [] }),
}));
vi.mock("../live/connection", () => ({
  Connection: class {
    constructor(_: string, listener: Listener) {
      fake.listener = listener;
    }
    send(): boolean {
      return true;
    }
  },
}));
vi.mock("../live/debug", () => ({ exposeDebug: (debug: Debug) => (fake.debug = debug), plain: () => null }));

describe("the page of the avatar alone", () => {
  const element = useFakePage();
  beforeEach(() => {
    vi.resetModules();
    vi.stubGlobal("location", { href: "http://localhost/avatar", protocol: "http:", host: "localhost" });
    vi.stubGlobal("requestAnimationFrame", () => 0);
    fake.built = 0;
  });

  /** Opens the page, and waits until the stage has been tried. */
  async function open(webgl: boolean): Promise<void> {
    fake.webgl = webgl;
    await import("./main");
    await vi.waitFor(() => expect(fake.built).toBe(1));
  }

  /** The program greets the page. */
  const greet = (): void =>
    fake.listener!.message({ type: "hello", protocol: PROTOCOL, looks: ["plain"] } as never);

  it("shows an avatar without words", async () => {
    await open(true);
    greet();
    await vi.waitFor(() => expect(fake.debug!.avatar?.name).toBe("plain"));
    expect(element("words").textContent).toBe("");
    expect(element("words").hidden).toBe(true);
  });
  it("goes on saying that WebGL is off", async () => {
    await open(false);
    for (let tries = 2; tries <= 3; tries++) {
      greet(); // the second time: with a new connection
      await vi.waitFor(() => expect(fake.built).toBe(tries));
      await vi.dynamicImportSettled();
      expect(element("words").textContent).toContain("WebGL is off");
      expect(element("words").hidden).toBe(false);
      expect(fake.debug!.avatar).toBeNull();
    }
  });
});
