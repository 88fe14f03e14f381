// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { encodeFrame } from "./frame";
import { toBytes } from "./messages";
import { FakeBroker, Page, TOPIC } from "./testing_meeting";

let broker: FakeBroker;
beforeEach(() => {
  vi.useFakeTimers();
  broker = new FakeBroker();
});
afterEach(() => vi.useRealTimers());

const wait = (ms: number) => vi.advanceTimersByTimeAsync(ms);

describe("a tracker on the same seat", () => {
  it("has its say; the page goes on to chat and to draw", async () => {
    const ana = new Page(broker, "p01", "Ana");
    const other = new Page(broker, "p02", "Bo");
    await wait(2000);
    broker.publish(`${TOPIC}/p/p01/presence`, toBytes({ here: true, session: 77 }), true);
    const state = { session: 77, kind: "tracker", name: "Ana T", seat: 0, avatar: { look: "robot" } };
    broker.publish(`${TOPIC}/p/p01/state`, toBytes(state), true);
    await wait(3000);
    expect(ana.client.me!.other?.kind).toBe("tracker");
    expect(other.names).toEqual(["Ana T", "Bo"]);
    ana.client.say("moving");
    await wait(500);
    expect(other.said.at(-1)).toBe("Ana T: moving");
    broker.publish(`${TOPIC}/p/p01/presence`, toBytes({ here: false, session: 77 }), true);
    await wait(3000);
    expect(other.names).toEqual(["Ana", "Bo"]);
  });
  it("is followed by the page even when the page's first words of it were lost", async () => {
    const ana = new Page(broker, "p01", "Ana");
    const other = new Page(broker, "p02", "Bo");
    await wait(2000);
    broker.publish(`${TOPIC}/p/p01/presence`, toBytes({ here: true, session: 77, every: 1.25 }), true);
    const state = { session: 77, kind: "tracker", name: "Ana T", seat: 0, avatar: null };
    broker.publish(`${TOPIC}/p/p01/state`, toBytes(state), true);
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
  it("is left alone by two windows of the same person", async () => {
    const pages = [new Page(broker, "p01", "Ana"), new Page(broker, "p01", "Ana")];
    const other = new Page(broker, "p02", "Bo");
    await wait(2000);
    const topic = `${TOPIC}/p/p01`;
    const state = { session: 77, kind: "tracker", name: "Ana T", seat: 0, avatar: null };
    const enter = () => {
      broker.publish(`${topic}/presence`, toBytes({ here: true, session: 77, every: 1.25 }), true);
      broker.publish(`${topic}/state`, toBytes(state), true);
    };
    enter();
    let sequence = 0;
    const move = async (frames: number) => {
      for (let i = 0; i < frames; i++) {
        sequence++;
        broker.publish(
          `${topic}/pose`,
          encodeFrame({
            tracked: true,
            still: false,
            session: 77,
            sequence,
            captured: BigInt(sequence * 33333),
            hips: [0, 1, 0],
            bones: [],
          }),
          false,
        );
        await wait(33);
        // As trackers do that hear that they are gone.
        const kept = broker.presenceOf("p01") as { here: boolean };
        if (!kept.here) enter();
      }
    };
    await move(30);
    await wait(6000); // it stands still
    expect(other.names).toEqual(["Ana", "Bo"]);
    await move(30);
    const told = broker.told;
    for (const p of pages) expect(p.client.me!.other).toEqual({ session: 77, kind: "tracker" });
    await move(300);
    expect(broker.told).toBe(told);
    expect(other.names).toEqual(["Ana T", "Bo"]);
    expect(broker.presenceOf("p01")).toMatchObject({ here: true, session: 77 });
  });
  it("is followed by the page when it vanishes, and has its say again when it was only late", async () => {
    const ana = new Page(broker, "p01", "Ana");
    const other = new Page(broker, "p02", "Bo");
    await wait(2000);
    const here = (yes: boolean) => toBytes({ here: yes, session: 77, ...(yes ? { every: 1.25 } : {}) });
    const state = { session: 77, kind: "tracker", name: "Ana T", seat: 0, avatar: null };
    const enter = () => {
      broker.publish(`${TOPIC}/p/p01/presence`, here(true), true);
      broker.publish(`${TOPIC}/p/p01/state`, toBytes(state), true);
    };
    const frame = (sequence: number) =>
      encodeFrame({
        tracked: true,
        still: false,
        session: 77,
        sequence,
        captured: BigInt(sequence * 33333),
        hips: [0, 1, 0],
        bones: [],
      });
    enter();
    broker.publish(`${TOPIC}/p/p01/pose`, frame(1), false);
    await wait(500);
    expect(other.names).toEqual(["Ana T", "Bo"]);
    await wait(6000);
    expect(other.names).toEqual(["Ana", "Bo"]);
    expect(ana.client.me!.other).toBeNull();
    expect(other.said).toEqual(["* Ana joined.", "* Ana T left.", "* Ana joined."]);
    broker.publish(`${TOPIC}/p/p01/pose`, frame(2), false);
    await wait(100);
    expect(ana.client.me!.other).toEqual({ session: 77, kind: "tracker" });
    expect(broker.presenceOf("p01")).toEqual({ v: 1, here: false, session: expect.any(Number) });
    enter(); // as trackers do that hear of it
    await wait(500);
    expect(other.names).toEqual(["Ana T", "Bo"]);
    expect(other.said.length).toBe(3);
    broker.publish(`${TOPIC}/p/p01/presence`, here(false), true);
    broker.publish(`${TOPIC}/p/p01/pose`, frame(3), false); // was on its way
    await wait(3000);
    expect(other.names).toEqual(["Ana", "Bo"]);
  });
});
