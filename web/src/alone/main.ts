// SPDX-License-Identifier: Apache-2.0
// The page /avatar: the avatar alone, for the browser source of OBS and its like. Viewers see what it shows: words appear only
// for mistakes in its address, while no avatar has been shown yet, or with ?debug.

import { PoseDriver } from "../avatar/driver";
import { fromAddress, fromProgram } from "../avatar/fetch";
import { AvatarError } from "../avatar/inspect";
import { Connection } from "../live/connection";
import { exposeDebug, plain } from "../live/debug";
import { Loop } from "../live/loop";
import { PROTOCOL, type Command, type Incoming, type Pose } from "../live/protocol";
import { VersionWatch } from "../live/version";
import { byId, setText } from "../shared/dom";
import { retryDelay, type ConnectionState } from "../shared/retry";
import type { AvatarInfo } from "../ui/avatars";
import { readOptions } from "./options";

const { options, mistakes } = readOptions(location.href);
const say = (words: string): void => {
  const box = byId("words", HTMLElement);
  box.hidden = !words;
  setText(box, words);
};
/** Something that the address cannot have meant. */
const mistake = (words: string): void => {
  if (options.debug || !avatar) say(words);
};
/** Something that may pass. */
const trouble = (words: string): void => {
  if (options.debug) say(words);
};

const send = (c: Command): boolean => connection?.send(c) ?? false;
const driver = new PoseDriver();
driver.mirrored = options.mirror;
const loop = new Loop(driver, [], send, mistake, { framing: options.framing, alone: true });

let avatar: AvatarInfo | null = null;
let loading = false;
let tries = 0;
let retry = 0;
const program = new VersionWatch();
let phase = "connecting";
let lastPose: Pose | null = null;
const counters = { poses: 0, lost: 0 };

/** Shows the avatar that the address names. A server that cannot be reached is asked again. */
async function showAvatar(looks: readonly string[]): Promise<void> {
  const wanted = options.avatar ?? looks[0] ?? "";
  if (avatar || loading) return;
  window.clearTimeout(retry);
  if (typeof wanted === "string" && !looks.includes(wanted)) {
    mistake(`Telemime has no avatar "${wanted}". It has ${looks.join(", ") || "none"}.`);
    return;
  }
  loading = true;
  try {
    const { name, data } = await (typeof wanted === "string" ? fromProgram(wanted) : fromAddress(wanted));
    const { loadAvatar } = await import("../avatar/load");
    const loaded = await loadAvatar(data);
    if (!(await loop.setAvatar(loaded))) return;
    const { version, author } = loaded.facts;
    avatar = { id: String(wanted), name, version, author };
    say("");
    if (loaded.notes.length > 0) trouble(`${name}: ${loaded.notes.join("; ")}.`);
  } catch (e) {
    if (e instanceof AvatarError) {
      mistake(e.message);
      return;
    }
    trouble(
      `${String(wanted)} could not be read: its server cannot be reached or forbids it (${String(e)}).`,
    );
    retry = window.setTimeout(() => void showAvatar(looks), retryDelay(tries++, Math.random()));
  } finally {
    loading = false;
  }
}

function onMessage(m: Incoming): void {
  switch (m.type) {
    case "hello":
      if (program.changed(m.version)) {
        location.reload();
        return;
      }
      if (m.protocol !== PROTOCOL)
        trouble("This page and the program have different versions. Reload the page.");
      void showAvatar(m.looks);
      break;
    case "body":
      driver.setBody(m);
      break;
    case "pose":
      lastPose = m;
      counters[m.state === "tracking" ? "poses" : "lost"]++;
      driver.setPose(m, performance.now() / 1000);
      break;
    case "status":
      phase = m.phase;
      if (phase !== "tracking") driver.setLost();
      break;
    case "message":
      if (m.level === "error") trouble(m.words);
      break;
    case "pong":
      break;
  }
}

function onConnection(s: ConnectionState): void {
  if (s.kind === "open") {
    if (avatar) say("");
    subscribe();
  } else if (s.kind === "lost") {
    phase = "disconnected";
    driver.setLost();
    trouble(s.words || "No connection to Telemime. Is the program running?");
  }
}

function visibility(): void {
  if (!document.hidden) driver.resume(performance.now() / 1000);
  subscribe();
}

/** No camera images, and no poses while the source is hidden. */
function subscribe(): void {
  send({ type: "pictures", on: false });
  send({ type: "poses", on: !document.hidden });
}

function begin(): Connection {
  const box = byId("avatar-view", HTMLElement);
  if (options.width) box.style.width = `${options.width}px`;
  if (options.height) box.style.height = `${options.height}px`;
  document.documentElement.style.background = options.background;
  document.addEventListener("visibilitychange", visibility);
  loop.start();
  const address = `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/ws`;
  return new Connection(address, { message: onMessage, picture: () => {}, state: onConnection });
}

let connection: Connection | null = null;
if (mistakes.length > 0) say(mistakes.join("\n"));
else connection = begin();

exposeDebug({
  get phase() {
    return phase;
  },
  get lastPose() {
    return plain(lastPose);
  },
  get avatar() {
    return avatar && { ...avatar };
  },
  get counters() {
    return { ...counters, ...loop.counters, misunderstood: connection?.misunderstood ?? 0 };
  },
  boneRotations: () => loop.avatar?.read() ?? {},
  expressions: () => loop.avatar?.face.read() ?? {},
});
