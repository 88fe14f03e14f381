// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { LocalParticipant } from "./local_participant";
import { readPresence, readState, toBytes } from "./messages";

const BASE = "r/lab/main";
const STATE = { name: "Ana", avatar: { look: "plain" }, seat: 2 };

function make() {
  const said: string[] = [];
  const me = new LocalParticipant(BASE, "p01", STATE, (topic, payload, retain) => {
    const kind = topic.split("/").at(-1)! + (retain ? "" : " once");
    if (payload.length === 0) said.push(`${kind} -`);
    else if (kind.startsWith("presence"))
      said.push(`${kind} ${readPresence(payload)!.here} ${readPresence(payload)!.session}`);
    else said.push(`${kind} ${readState(payload)!.name} ${readState(payload)!.session}`);
  });
  const take = () => said.splice(0);
  return { me, take };
}

const presence = (here: boolean, session: number) => toBytes({ here, session });
const tracker = (session: number) =>
  toBytes({ session, kind: "tracker", name: "Ana", seat: 2, avatar: null });

describe("this page as a participant", () => {
  it("says that it is here once the meeting has told what it knows", () => {
    const { me, take } = make();
    me.connected(7);
    expect(take()).toEqual([]);
    me.settled();
    expect(take()).toEqual(["presence true 7", "state Ana 7"]);
    expect(me.announced).toBe(true);
    me.receive("presence", presence(true, 7)); // its own words
    expect(take()).toEqual([]);
    me.change({ ...STATE, name: "Anna" });
    expect(take()).toEqual(["state Anna 7"]);
    me.leave();
    expect(take()).toEqual(["presence false 7", "state -"]);
    me.leave();
    expect(take()).toEqual([]);
  });
  it("does not take its own earlier connection, whose last will was lost, for somebody else", () => {
    const { me, take } = make();
    me.connected(7);
    me.settled();
    take();
    me.connected(8);
    me.receive("presence", presence(true, 7)); // as the broker has kept it
    me.settled();
    expect(me.other).toBeNull();
    expect(take()).toEqual(["presence true 8", "state Ana 8"]);
    me.receive("presence", presence(true, 7));
    expect(me.other).toBeNull();
  });
  it("says nothing when a tracker speaks for the same seat, until that has gone", () => {
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
    me.receive("state", tracker(50)); // in the other order
    me.receive("presence", presence(true, 50));
    me.settled();
    expect(me.other).toEqual({ session: 50, kind: "tracker" });
    me.receive("presence", presence(false, 50));
    expect(take()).toEqual(["presence true 8", "state Anna 8"]);
    expect(me.other).toBeNull();
  });
  it("steps back for a tracker that comes later", () => {
    const { me, take } = make();
    me.connected(7);
    me.settled();
    take();
    me.receive("presence", presence(true, 50));
    me.receive("state", tracker(50));
    me.receive("presence", presence(false, 49)); // of somebody before
    expect(take()).toEqual([]);
    expect(me.other?.kind).toBe("tracker");
    me.receive("presence", presence(false, 50));
    expect(take()).toEqual(["presence true 7", "state Ana 7"]);
  });
  it("says it again when the will of its last connection comes late, or somebody wipes it", () => {
    const { me, take } = make();
    me.connected(7);
    me.settled();
    take();
    me.receive("presence", presence(false, 6));
    expect(take()).toEqual(["presence true 7", "state Ana 7"]);
    me.receive("presence", new Uint8Array(0));
    expect(take()).toEqual(["presence true 7", "state Ana 7"]);
  });
  it("breathes while it is here and nobody else speaks for it", () => {
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
  it("speaks for two windows that came in the same moment in just one of them", () => {
    const window = (session: number) =>
      toBytes({ session, kind: "browser", name: "Ana", seat: 2, avatar: null });
    for (const told of [true, false]) {
      const said = [7, 8].map((session) => {
        const { me, take } = make();
        me.connected(session);
        me.settled();
        take();
        me.receive("presence", presence(true, 15 - session));
        if (told) me.receive("state", window(15 - session));
        me.signalPresence();
        me.change({ ...STATE, name: "Anna" });
        me.leave();
        return take();
      });
      expect(said).toEqual([[], ["presence once true 8", "state Anna 8", "presence false 8", "state -"]]);
    }
  });
  it("takes the place of somebody who has vanished, and gives it back when their frames come again", () => {
    const { me, take } = make();
    me.connected(7);
    me.receive("presence", presence(true, 50));
    me.receive("state", tracker(50));
    me.vanished(); // while the meeting still tells what it knows
    expect(take()).toEqual([]);
    me.receive("presence", presence(true, 50));
    me.settled();
    expect(take()).toEqual([]);
    me.vanished();
    expect(take()).toEqual(["presence true 7", "state Ana 7"]);
    me.vanished(); // nobody else is there
    expect(take()).toEqual([]);
    me.tracked(50);
    expect(take()).toEqual(["presence false 7"]); // the tracker then tells what it is
    expect(me.other).toEqual({ session: 50, kind: "tracker" });
    me.receive("presence", presence(false, 7));
    me.tracked(50);
    me.signalPresence();
    me.leave();
    expect(take()).toEqual([]);
  });
  it("gives the place back to a tracker that says so before its frames come, or whose will came late", () => {
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
      me.receive("presence", presence(true, 50)); // and its state: it has heard that it is gone
      me.tracked(50);
      me.signalPresence();
      expect(take()).toEqual([]);
      me.receive("presence", presence(false, 50));
      expect(take()).toEqual(["presence true 7", "state Ana 7"]);
    }
  });
  it("is silent while a tracker speaks, whatever other windows say", () => {
    const { me, take } = make();
    me.connected(9);
    me.settled();
    take();
    me.tracked(50);
    expect(take()).toEqual(["presence false 9"]);
    for (const here of [true, false]) me.receive("presence", presence(here, 7));
    me.tracked(50);
    me.signalPresence();
    expect(take()).toEqual([]);
    me.tracked(51); // started anew
    me.receive("presence", presence(false, 50)); // the will of the old one
    expect(take()).toEqual([]);
    me.receive("presence", presence(false, 51));
    expect(take()).toEqual(["presence true 9", "state Ana 9"]);
  });
  it("says nothing after goodbye", () => {
    const { me, take } = make();
    me.connected(7);
    me.settled();
    me.leave();
    take();
    me.receive("presence", presence(false, 7));
    expect(take()).toEqual([]);
  });
});
