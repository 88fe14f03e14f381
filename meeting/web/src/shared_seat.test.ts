// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { FakeBroker, Page } from "./testing_meeting";

let broker: FakeBroker, ana: Page, other: Page;
const wait = (ms: number) => vi.advanceTimersByTimeAsync(ms);
beforeEach(async () => {
  vi.useFakeTimers();
  broker = new FakeBroker();
  ana = new Page(broker, "p01", "Ana");
  other = new Page(broker, "p02", "Bo");
});
afterEach(() => vi.useRealTimers());

const SESSION = { session: 77 };
const LEFT = () => broker.presence("p01", false, SESSION);
/** The tracker announces itself, with a promise of messages every 1.25 s. */
function enter(): void {
  broker.presence("p01", true, { ...SESSION, every: 1.25 });
  broker.state("p01", "Ana T", 0, SESSION);
}

describe("a tracker on the same seat", () => {
  it("moves the avatar while the page chats", async () => {
    await wait(2000);
    broker.presence("p01", true, SESSION);
    broker.state("p01", "Ana T", 0, { ...SESSION, avatar: { look: "robot" } });
    await wait(3000);
    expect(ana.client.me!.other?.kind).toBe("tracker");
    expect(other.names).toEqual(["Ana T", "Bo"]);
    ana.client.write("moving");
    await wait(500);
    expect(other.said.at(-1)).toBe("Ana T: moving");
    LEFT();
    await wait(3000);
    expect(other.names).toEqual(["Ana", "Bo"]);
  });
  it("is replaced after a lost message", async () => {
    await wait(2000);
    enter();
    await wait(1000);
    expect(ana.client.me!.other?.session).toBe(77);
    const publish = broker.publish.bind(broker);
    broker.publish = (topic, ...rest) => void (topic.includes("/p01/") || publish(topic, ...rest));
    await wait(5000);
    expect(ana.client.me!.other).toBeNull();
    expect(other.names).toEqual(["Bo"]);
    ana.client.tryNow();
    broker.cut("p01");
    broker.publish = publish;
    await wait(10000);
    expect(ana.client.me!.other).toBeNull();
    expect(other.names).toEqual(["Ana", "Bo"]);
  });
  it("is not disturbed by two windows", async () => {
    const pages = [ana, new Page(broker, "p01", "Ana")];
    await wait(2000);
    enter();
    let sequence = 0;
    const move = async (frames: number) => {
      for (let i = 0; i < frames; i++) {
        broker.frame("p01", ++sequence);
        await wait(33);
        // Trackers announce themselves again when they receive that they have left.
        if (!broker.stored("p/p01/presence").here) enter();
      }
    };
    await move(30);
    await wait(6000); // it stands still
    expect(other.names).toEqual(["Ana", "Bo"]);
    await move(30);
    const { retained } = broker;
    for (const p of pages) expect(p.client.me!.other).toEqual({ session: 77, kind: "tracker" });
    await move(300);
    expect(broker.retained).toBe(retained);
    expect(other.names).toEqual(["Ana T", "Bo"]);
    expect(broker.stored("p/p01/presence")).toMatchObject({ here: true, session: 77 });
  });
  it("is replaced until it returns", async () => {
    await wait(2000);
    enter();
    broker.frame("p01", 1);
    await wait(500);
    expect(other.names).toEqual(["Ana T", "Bo"]);
    await wait(6000);
    expect(other.names).toEqual(["Ana", "Bo"]);
    expect(ana.client.me!.other).toBeNull();
    expect(other.said).toEqual(["* Ana joined.", "* Ana T left.", "* Ana joined."]);
    broker.frame("p01", 2);
    await wait(100);
    expect(ana.client.me!.other).toEqual({ session: 77, kind: "tracker" });
    expect(broker.stored("p/p01/presence")).toEqual({ v: 1, here: false, session: expect.any(Number) });
    enter(); // as trackers do that receive this
    await wait(500);
    expect(other.names).toEqual(["Ana T", "Bo"]);
    expect(other.said.length).toBe(3);
    LEFT();
    broker.frame("p01", 3); // was on its way
    await wait(3000);
    expect(other.names).toEqual(["Ana", "Bo"]);
  });
});
