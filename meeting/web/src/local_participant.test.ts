// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { LocalParticipant } from "./local_participant";
import { readPresence, readState, toBytes } from "./messages";

const BASE = "r/lab/main";
const STATE = { name: "Ana", avatar: { look: "plain" }, seat: 2 };

/** This page as a participant; with `session` it has announced itself. `take` gives what it has published since. */
function make(session?: number) {
  const said: string[] = [];
  const me = new LocalParticipant(BASE, "p01", STATE, (topic, payload, retain) => {
    const kind = topic.split("/").at(-1)! + (retain ? "" : " once");
    if (payload.length === 0) said.push(`${kind} -`);
    else if (kind.startsWith("presence"))
      said.push(`${kind} ${readPresence(payload)!.here} ${readPresence(payload)!.session}`);
    else said.push(`${kind} ${readState(payload)!.name} ${readState(payload)!.session}`);
  });
  const take = () => said.splice(0);
  if (session !== undefined) {
    me.connected(session);
    me.settled();
    take();
  }
  return { me, take };
}

const presence = (here: boolean, session: number) => toBytes({ here, session });
const tracker = (session: number) =>
  toBytes({ session, kind: "tracker", name: "Ana", seat: 2, avatar: null });

describe("this page as a participant", () => {
  it("announces itself once settled", () => {
    const { me, take } = make();
    me.connected(7);
    expect(take()).toEqual([]);
    me.settled();
    expect(take()).toEqual(["presence true 7", "state Ana 7"]);
    expect(me.here).toBe(true);
    me.receive("presence", presence(true, 7)); // its own message
    expect(take()).toEqual([]);
    me.change({ ...STATE, name: "Anna" });
    expect(take()).toEqual(["state Anna 7"]);
    me.leave();
    expect(take()).toEqual(["presence false 7", "state -"]);
    me.leave();
    expect(take()).toEqual([]);
  });
  it("recognises its own earlier connection", () => {
    const { me, take } = make(7);
    me.connected(8);
    me.receive("presence", presence(true, 7)); // as the broker has kept it
    me.settled();
    expect(me.other).toBeNull();
    expect(take()).toEqual(["presence true 8", "state Ana 8"]);
    me.receive("presence", presence(true, 7));
    expect(me.other).toBeNull();
  });
  it("is silent while a tracker is here", () => {
    const { me, take } = make();
    me.connected(7);
    me.receive("presence", presence(true, 50));
    me.receive("state", tracker(50));
    me.settled();
    expect(take()).toEqual([]);
    expect(me.other).toEqual({ session: 50, kind: "tracker" });
    me.change({ ...STATE, name: "Anna" });
    me.leave();
    expect(take()).toEqual([]);
    me.connected(8);
    me.receive("state", tracker(50)); // in the opposite order
    me.receive("presence", presence(true, 50));
    me.settled();
    expect(me.other).toEqual({ session: 50, kind: "tracker" });
    me.receive("presence", presence(false, 50));
    expect(take()).toEqual(["presence true 8", "state Anna 8"]);
    expect(me.other).toBeNull();
  });
  it("yields to a tracker that joins later", () => {
    const { me, take } = make(7);
    me.receive("presence", presence(true, 50));
    me.receive("state", tracker(50));
    me.receive("presence", presence(false, 49)); // of an earlier session
    expect(take()).toEqual([]);
    expect(me.other?.kind).toBe("tracker");
    me.receive("presence", presence(false, 50));
    expect(take()).toEqual(["presence true 7", "state Ana 7"]);
  });
  it("repeats its presence after a late will", () => {
    const { me, take } = make(7);
    me.receive("presence", presence(false, 6));
    expect(take()).toEqual(["presence true 7", "state Ana 7"]);
    me.receive("presence", new Uint8Array(0));
    expect(take()).toEqual(["presence true 7", "state Ana 7"]);
  });
  it("signals its presence while it is active", () => {
    const { me, take } = make();
    me.signalPresence();
    me.connected(7);
    me.signalPresence();
    expect(take()).toEqual([]);
    me.settled();
    take();
    me.signalPresence();
    expect(take()).toEqual(["presence once true 7"]);
    me.receive("presence", presence(true, 50));
    me.receive("state", tracker(50));
    me.signalPresence();
    expect(take()).toEqual([]);
    me.receive("presence", presence(false, 50));
    take();
    me.leave();
    take();
    me.signalPresence();
    expect(take()).toEqual([]);
  });
  it("publishes in one of two equal windows", () => {
    const window = (session: number) =>
      toBytes({ session, kind: "browser", name: "Ana", seat: 2, avatar: null });
    for (const stated of [true, false]) {
      const said = [7, 8].map((session) => {
        const { me, take } = make(session);
        me.receive("presence", presence(true, 15 - session));
        if (stated) me.receive("state", window(15 - session));
        me.signalPresence();
        me.change({ ...STATE, name: "Anna" });
        me.leave();
        return take();
      });
      expect(said).toEqual([[], ["presence once true 8", "state Anna 8", "presence false 8", "state -"]]);
    }
  });
  it("replaces a vanished tracker for a while", () => {
    const { me, take } = make();
    me.connected(7);
    me.receive("presence", presence(true, 50));
    me.receive("state", tracker(50));
    me.vanished(); // while retained messages arrive
    expect(take()).toEqual([]);
    me.receive("presence", presence(true, 50));
    me.settled();
    expect(take()).toEqual([]);
    me.vanished();
    expect(take()).toEqual(["presence true 7", "state Ana 7"]);
    me.vanished(); // there is no other client
    expect(take()).toEqual([]);
    me.tracked(50);
    expect(take()).toEqual(["presence false 7"]); // the tracker then publishes its state
    expect(me.other).toEqual({ session: 50, kind: "tracker" });
    me.receive("presence", presence(false, 7));
    me.tracked(50);
    me.signalPresence();
    me.leave();
    expect(take()).toEqual([]);
  });
  it("yields to a returning tracker's presence", () => {
    for (const why of ["silent", "late will"]) {
      const { me, take } = make();
      me.connected(7);
      me.receive("presence", presence(true, 50));
      me.receive("state", tracker(50));
      me.settled();
      if (why === "silent") me.vanished();
      else me.receive("presence", presence(false, 50)); // of its older connection
      expect(take()).toEqual(["presence true 7", "state Ana 7"]);
      me.receive("presence", presence(true, 50));
      expect(take()).toEqual(["presence false 7"]);
      me.receive("presence", presence(false, 7));
      me.receive("presence", presence(true, 50)); // it repeats its presence and state
      me.tracked(50);
      me.signalPresence();
      expect(take()).toEqual([]);
      me.receive("presence", presence(false, 50));
      expect(take()).toEqual(["presence true 7", "state Ana 7"]);
    }
  });
  it("is silent with a tracker and windows", () => {
    const { me, take } = make(9);
    me.tracked(50);
    expect(take()).toEqual(["presence false 9"]);
    for (const here of [true, false]) me.receive("presence", presence(here, 7));
    me.tracked(50);
    me.signalPresence();
    expect(take()).toEqual([]);
    me.tracked(51); // restarted
    me.receive("presence", presence(false, 50)); // the last will of the old one
    expect(take()).toEqual([]);
    me.receive("presence", presence(false, 51));
    expect(take()).toEqual(["presence true 9", "state Ana 9"]);
  });
  it("publishes nothing after it has left", () => {
    const { me, take } = make(7);
    me.leave();
    take();
    me.receive("presence", presence(false, 7));
    expect(take()).toEqual([]);
  });
});
