// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it, vi } from "vitest";
import type { Listener } from "../live/connection";
import type { Debug } from "../live/debug";
import { PROTOCOL } from "../live/protocol";
import { useFakePage } from "../shared/testing_dom";

const fake = vi.hoisted(() => ({
  failure: null as Error | null,
  unreachable: 0,
  reloaded: 0,
  listener: null as Listener | null,
  debug: null as Debug | null,
  built: 0,
}));

vi.mock("../avatar/stage", () => ({
  Stage: class {
    readonly painter = { software: false };
    constructor() {
      fake.built++;
      if (fake.failure) throw fake.failure;
    }
    setAvatar(): void {}
  },
}));
vi.mock("../avatar/fetch", () => ({
  fromProgram: (name: string) => Promise.resolve({ name, data: new ArrayBuffer(0) }),
  fromAddress: () =>
    fake.unreachable-- > 0
      ? Promise.reject(new TypeError("Failed to fetch"))
      : Promise.resolve({ name: "me.vrm", data: new ArrayBuffer(0) }),
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
    vi.stubGlobal("location", {
      href: "http://localhost/avatar",
      protocol: "http:",
      host: "localhost",
      reload: () => fake.reloaded++,
    });
    vi.stubGlobal("requestAnimationFrame", () => 0);
    Object.assign(fake, { failure: null, unreachable: 0, reloaded: 0, built: 0 });
  });

  /** Opens the page, and waits until the stage has been tried. */
  async function open(): Promise<void> {
    await import("./main");
    await vi.waitFor(() => expect(fake.built).toBe(1));
  }

  /** The program greets the page. */
  const greet = (version = "1"): void =>
    fake.listener!.message({ type: "hello", protocol: PROTOCOL, version, looks: ["plain"] } as never);

  it("shows an avatar without words", async () => {
    await open();
    greet();
    await vi.waitFor(() => expect(fake.debug!.avatar?.name).toBe("plain"));
    expect(element("words").textContent).toBe("");
    expect(element("words").hidden).toBe(true);
  });
  it("follows on when it is seen again", async () => {
    const { PoseDriver } = await import("../avatar/driver");
    const resume = vi.spyOn(PoseDriver.prototype, "resume");
    let changed = (): void => {};
    Object.assign(document, { addEventListener: (_: string, then: () => void) => (changed = then) });
    await open();
    for (const [hidden, times] of [
      [true, 0],
      [false, 1],
    ] as const) {
      Object.assign(document, { hidden });
      changed();
      expect(resume).toHaveBeenCalledTimes(times);
    }
  });
  it("asks an unreachable server again", async () => {
    location.href = "http://localhost/avatar?avatar=https://example.org/me.vrm";
    fake.unreachable = 2;
    await open();
    greet();
    await vi.waitFor(() => expect(fake.debug!.avatar?.name).toBe("me.vrm"), { timeout: 5000 });
    expect(element("words").hidden).toBe(true);
  });
  it("is loaded again for another version", async () => {
    await open();
    greet("1");
    await vi.waitFor(() => expect(fake.debug!.avatar).not.toBeNull());
    greet("1");
    expect(fake.reloaded).toBe(0);
    greet("2");
    expect(fake.reloaded).toBe(1);
  });
  it("goes on saying that WebGL is off", async () => {
    const { NoWebGl } = await import("../shared/graphics");
    fake.failure = new NoWebGl();
    await open();
    for (let tries = 2; tries <= 3; tries++) {
      greet(); // the second time: with a new connection
      await vi.waitFor(() => expect(fake.built).toBe(tries));
      await vi.dynamicImportSettled();
      expect(element("words").textContent).toMatch(/WebGL is off in this browser\.$/);
      expect(element("words").hidden).toBe(false);
      expect(fake.debug!.avatar).toBeNull();
    }
  });
});
