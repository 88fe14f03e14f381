// SPDX-License-Identifier: Apache-2.0
// The WebSocket to the program: opens, hears, says, and opens again with growing pauses.

import { parseMessage, parsePicture, type Command, type Incoming, type Picture } from "./protocol";

export type ConnectionState =
  | { kind: "connecting" }
  | { kind: "open" } // and the program has spoken
  | { kind: "lost"; retryAt: number; words: string }; // performance.now() of the next try; why, when it was told

export interface Listener {
  message(m: Incoming): void;
  picture(p: Picture): void;
  state(s: ConnectionState): void;
}

const PING_EVERY = 4000; // ms
const SILENCE = 12000; // ms without a word: the connection is dead, even if the socket does not say so
/** Codes by which the program itself turns a page away (RFC 6455 and its registry): policy, try again later. */
const TURNED_AWAY: readonly number[] = [1008, 1013];
const MAX_WAITING = 1 << 16; // bytes: a connection that does not drain gets no more "drawn"

/** Pause before try number `n` (from 0), ms: 0.5 s, doubled up to 10 s; `chance` in [0, 1) spreads many pages. */
export function pause(n: number, chance: number): number {
  return Math.min(10000, 500 * 2 ** n) * (0.8 + 0.4 * chance);
}

export class Connection {
  private socket: WebSocket | null = null;
  private tries = 0;
  private retry = 0;
  private heard = 0;
  private pingId = 0;
  private refused = 0;
  private current: ConnectionState = { kind: "connecting" };

  constructor(
    private readonly url: string,
    private readonly listener: Listener,
  ) {
    window.setInterval(() => this.heartbeat(), PING_EVERY);
    window.addEventListener("online", () => this.tryNow());
    this.open();
  }

  get state(): ConnectionState {
    return this.current;
  }

  /** Messages that this page did not understand. */
  get misunderstood(): number {
    return this.refused;
  }

  /** False when there is no connection: nothing is kept to be said later. */
  send(command: Command): boolean {
    const s = this.socket;
    if (!s || s.readyState !== WebSocket.OPEN) return false;
    if (command.type === "drawn" && s.bufferedAmount > MAX_WAITING) return false;
    s.send(JSON.stringify(command));
    return true;
  }

  tryNow(): void {
    if (this.current.kind === "lost") this.open();
  }

  private open(): void {
    window.clearTimeout(this.retry);
    this.set({ kind: "connecting" });
    let s: WebSocket;
    try {
      s = new WebSocket(this.url);
    } catch {
      this.failed("");
      return;
    }
    s.binaryType = "arraybuffer";
    this.socket = s;
    this.heard = performance.now();
    s.onopen = () => (this.heard = performance.now());
    s.onmessage = (e: MessageEvent<unknown>) => {
      this.heard = performance.now();
      // The program speaks: it is not only an open port, or a word that no more pages are let in.
      this.tries = 0;
      if (this.current.kind !== "open") this.set({ kind: "open" });
      if (typeof e.data === "string") {
        const m = parseMessage(e.data);
        if (m) this.listener.message(m);
        else this.refused++;
      } else if (e.data instanceof ArrayBuffer) {
        const p = parsePicture(e.data);
        if (p) this.listener.picture(p);
        else this.refused++;
      }
    };
    s.onclose = (e: CloseEvent) => {
      if (this.socket === s) this.failed(TURNED_AWAY.includes(e.code) ? e.reason : "");
    };
  }

  private failed(words: string): void {
    this.socket = null;
    const wait = pause(this.tries++, Math.random());
    this.retry = window.setTimeout(() => this.open(), wait);
    this.set({ kind: "lost", retryAt: performance.now() + wait, words });
  }

  private heartbeat(): void {
    const s = this.socket;
    if (!s) return;
    if (performance.now() - this.heard > SILENCE) {
      this.socket = null;
      s.onmessage = null;
      s.close();
      this.failed("");
      return;
    }
    this.send({ type: "ping", id: ++this.pingId });
  }

  private set(s: ConnectionState): void {
    this.current = s;
    this.listener.state(s);
  }
}
