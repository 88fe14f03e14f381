// SPDX-License-Identifier: Apache-2.0
// The WebSocket to the program. It opens again by itself, with growing delays.

import { retryDelay, type ConnectionState } from "../shared/retry";
import { parseMessage, parsePicture, type Command, type Incoming, type Picture } from "./protocol";

export interface Listener {
  message(m: Incoming): void;
  picture(p: Picture): void;
  state(s: ConnectionState): void;
}

const PING_INTERVAL = 4000; // ms
const SILENCE = 12000; // ms without a message: the connection is dead, even if the socket does not report it
/** Close codes by which the program itself refuses a page (RFC 6455 and its registry): policy, try again later. */
const REFUSED: readonly number[] = [1008, 1013];
const MAX_BUFFERED = 1 << 16; // bytes: a connection that does not drain gets no more "drawn"

export class Connection {
  private socket: WebSocket | null = null;
  private tries = 0;
  private retry = 0;
  private lastMessage = 0;
  private pingId = 0;
  /** The number of messages that this page did not understand. */
  misunderstood = 0;
  private current: ConnectionState = { kind: "connecting" };

  constructor(
    private readonly url: string,
    private readonly listener: Listener,
  ) {
    window.setInterval(() => this.heartbeat(), PING_INTERVAL);
    window.addEventListener("online", () => this.tryNow());
    this.open();
  }

  /** False when there is no connection: nothing is queued. */
  send(command: Command): boolean {
    const s = this.socket;
    if (!s || s.readyState !== WebSocket.OPEN) return false;
    if (command.type === "drawn" && s.bufferedAmount > MAX_BUFFERED) return false;
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
    this.lastMessage = performance.now();
    s.onopen = () => (this.lastMessage = performance.now());
    s.onmessage = (e: MessageEvent<unknown>) => this.received(e.data);
    s.onclose = (e: CloseEvent) => {
      if (this.socket === s) this.failed(REFUSED.includes(e.code) ? e.reason : "");
    };
  }

  private received(data: unknown): void {
    this.lastMessage = performance.now();
    // A first message shows that the program serves this page: an open socket alone may still be refused.
    this.tries = 0;
    if (this.current.kind !== "open") this.set({ kind: "open" });
    if (typeof data === "string") {
      const m = parseMessage(data);
      if (m) this.listener.message(m);
      else this.misunderstood++;
    } else if (data instanceof ArrayBuffer) {
      const p = parsePicture(data);
      if (p) this.listener.picture(p);
      else this.misunderstood++;
    }
  }

  private failed(words: string): void {
    this.socket = null;
    const wait = retryDelay(this.tries++, Math.random());
    this.retry = window.setTimeout(() => this.open(), wait);
    this.set({ kind: "lost", retryAt: performance.now() + wait, words });
  }

  private heartbeat(): void {
    const s = this.socket;
    if (!s) return;
    if (performance.now() - this.lastMessage > SILENCE) {
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
