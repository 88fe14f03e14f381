// SPDX-License-Identifier: Apache-2.0
// A client of the program beside the page: what it says, to compare with, and when it says it, to wait for.

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
    listener.#socket.on("message", (data, binary) => binary || listener.#hear(JSON.parse(data.toString())));
    listener.#socket.on("error", () => {}); // followed by close
    listener.#socket.on("close", () => {
      for (const w of listener.#waiting) w.reject(new Error("the program has closed the connection"));
    });
    await listener.heard((m) => m.type === "hello");
    listener.say({ type: "pictures", on: false });
    return listener;
  }

  #hear(message) {
    if (message.type === "pose") this.poses.set(message.frame, message);
    if (message.type === "status") this.status = message;
    for (const w of [...this.#waiting]) {
      if (!w.wanted(message)) continue;
      this.#waiting.delete(w);
      w.resolve(message);
    }
  }

  /** The next message that is `wanted`. */
  heard(wanted) {
    return new Promise((resolve, reject) => this.#waiting.add({ wanted, resolve, reject }));
  }

  /** Another `count` frames in which the person was tracked. */
  async tracked(count) {
    let seen = 0;
    await this.heard((m) => m.type === "pose" && m.state === "tracking" && ++seen >= count);
  }

  async inPhase(phase) {
    if (this.status?.phase !== phase) await this.heard((m) => m.type === "status" && m.phase === phase);
  }

  say(message) {
    this.#socket.send(JSON.stringify(message));
  }

  close() {
    this.#socket.terminate();
  }
}
