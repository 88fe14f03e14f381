// SPDX-License-Identifier: Apache-2.0
// A connection by MQTT 3.1.1 over WebSocket, with mqtt.js.

import mqtt, { type ErrorWithReasonCode, type IClientOptions } from "mqtt";
import type { Entered } from "./entry";
import type { Closed, Dial } from "./link";
import { PRESENCE_INTERVAL } from "./local_participant";
import { steadyTimer } from "./ticker";

const KEEP_ALIVE = 10; // s
const TIMEOUT = 8000; // ms for an answer of the broker
/**
 * Between pings, ms. The broker needs fewer, but a busy computer may send them late. The answers also show whether a
 * silence is that of the participants or of the connection (roster.ts).
 */
const PING = 1500;

const REFUSED: Record<number, string> = {
  1: "The broker uses another version of MQTT.",
  2: "The broker rejected this page's client name.",
  4: "This seat is no longer valid.",
  5: "This seat is no longer valid.",
};

/** 8 hex digits. */
const digits = (): string => crypto.getRandomValues(new Uint32Array(1))[0]!.toString(16).padStart(8, "0");

/** `will`: what the broker publishes for this page when the connection breaks. */
export function brokerDial(
  entered: Entered,
  will: { topic: string; payload: (session: number) => Uint8Array } | null,
): Dial {
  return (session, events) => {
    const options: IClientOptions = {
      protocolVersion: 4,
      clean: true,
      clientId: `${entered.participant ?? "watch"}-${digits()}`,
      username: entered.user,
      password: entered.password,
      keepalive: KEEP_ALIVE,
      timerVariant: steadyTimer,
      connectTimeout: TIMEOUT,
      reconnectPeriod: 0, // link.ts reconnects
      resubscribe: false,
      queueQoSZero: false,
      ...(will
        ? { will: { topic: will.topic, payload: will.payload(session) as Buffer, qos: 1, retain: true } }
        : {}),
    };
    const client = mqtt.connect(entered.mqtt, options);
    let over = false;
    let opened = false;
    let why: Closed | null = null;
    const timers = [
      steadyTimer.set(() => void (client.connected && client.sendPing()), PING),
      steadyTimer.set(() => void (client.connected && opened && events.pulse()), 1000 * PRESENCE_INTERVAL),
    ];
    const stopTimers = (): void => timers.forEach((t) => steadyTimer.clear(t));
    const closed = (): void => {
      if (over) return;
      over = true;
      stopTimers();
      client.end(true);
      events.closed(
        why ?? {
          refused: false,
          words: opened ? "The connection to the meeting is lost." : "The broker does not answer.",
        },
      );
    };
    const subscribe = (qos: 0 | 1): void => {
      client.subscribe(`${entered.topic}/#`, { qos }, (error, granted) => {
        if (over) return;
        if (error || granted?.some((g) => g.qos > 2)) {
          // A cluster that has just lost a node may have no storage for unconfirmed messages. It still delivers them.
          if (qos === 1) return subscribe(0);
          why = { refused: true, words: "The broker does not allow this page to subscribe to the meeting." };
          closed();
          return;
        }
        opened = true;
        events.open();
      });
    };
    client.on("connect", () => subscribe(1));
    client.on("packetreceive", () => {
      if (!over) events.alive();
    });
    client.on("message", (topic, payload, packet) => {
      if (!over) events.message(topic, payload, packet.retain);
    });
    client.on("error", (e: Error | ErrorWithReasonCode) => {
      const code = "code" in e && typeof e.code === "number" ? e.code : 0;
      if (REFUSED[code]) why = { refused: true, words: REFUSED[code] };
      closed();
    });
    client.on("close", closed);
    return {
      publish: async (topic, payload, retain) => {
        await client.publishAsync(topic, payload as Buffer, { qos: 1, retain });
      },
      close: () => {
        over = true;
        stopTimers();
        client.on("error", () => undefined);
        client.end(); // after sending what is queued
      },
    };
  };
}
