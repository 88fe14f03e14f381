// SPDX-License-Identifier: Apache-2.0
// A client of the program beside the page: it collects the messages of the program and waits for them.

import { WebSocket } from "ws";

export class Listener {
  /** Pose messages by frame. */
  poses = new Map();
  status = null;
  #socket;
  #waiting = new Set();

  static async open(program) {
    const listener = new Listener();
    listener.#socket = new WebSocket(`ws://localhost:${program.port}/ws`, { perMessageDeflate: false });
    listener.#socket.on(
      "message",
      (data, binary) => binary || listener.#receive(JSON.parse(data.toString())),
    );
    listener.#socket.on("error", () => {}); // followed by close
    listener.#socket.on("close", () => {
      for (const w of listener.#waiting) w.reject(new Error("the program has closed the connection"));
    });
    await listener.next((m) => m.type === "hello");
    listener.send({ type: "pictures", on: false });
    return listener;
  }

  #receive(message) {
    if (message.type === "pose") this.poses.set(message.frame, message);
    if (message.type === "status") this.status = message;
    for (const w of [...this.#waiting]) {
      if (!w.wanted(message)) continue;
      this.#waiting.delete(w);
      w.resolve(message);
    }
  }

  /** The next message for which `wanted` gives true. */
  next(wanted) {
    return new Promise((resolve, reject) => this.#waiting.add({ wanted, resolve, reject }));
  }

  /** Another `count` frames in which the person was tracked. */
  async tracked(count) {
    let seen = 0;
    await this.next((m) => m.type === "pose" && m.state === "tracking" && ++seen >= count);
  }

  async inPhase(phase) {
    if (this.status?.phase !== phase) await this.next((m) => m.type === "status" && m.phase === phase);
  }

  send(message) {
    this.#socket.send(JSON.stringify(message));
  }

  close() {
    this.#socket.terminate();
  }
}
