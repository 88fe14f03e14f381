// SPDX-License-Identifier: Apache-2.0
// The live page: connects the WebSocket, the views and the controls.

import { PoseDriver } from "../avatar/driver";
import { button, byId, setText } from "../shared/dom";
import { buildFrame } from "../shared/frame";
import { Banner, Toasts } from "../shared/notices";
import { Panel } from "../shared/panel";
import type { ConnectionState } from "../shared/retry";
import { Shortcuts } from "../shared/shortcuts";
import { Avatars } from "../ui/avatars";
import { Guide } from "../ui/guide";
import { OutputList } from "../ui/outputs";
import { privacyNote } from "../ui/privacy";
import { Recordings } from "../ui/recordings";
import { storedSettings, type Settings } from "../ui/settings";
import { LiveState } from "../ui/state";
import { CameraView } from "../views/camera";
import { Gauges } from "../views/gauges";
import { TopView } from "../views/top";
import { Connection } from "./connection";
import { exposeDebug, plain } from "./debug";
import { Loop } from "./loop";
import { PROTOCOL, type Command, type Incoming, type Phase, type Pose, type Status } from "./protocol";
import { VersionWatch } from "./version";

buildFrame({ state: "Connecting", note: privacyNote(location.hostname) });

const stored = storedSettings();
const settings: Settings = stored.load();
const save = () => stored.save(settings);

const send = (c: Command): boolean => connection.send(c);
const driver = new PoseDriver();
const camera = new CameraView(byId("camera-canvas", HTMLCanvasElement));
const top = new TopView(byId("top-canvas", HTMLCanvasElement));
const gauges = new Gauges();
const toasts = new Toasts();
const line = new LiveState();
const announce = (words: string) => line.announce(words);
const banner = new Banner(() => connection.tryNow());
const loop = new Loop(driver, [camera, top], send, (words) => toasts.show("error", words));
const avatars = new Avatars(
  {
    // The 3-D library is the largest part of the page. It is loaded separately.
    load: async (data) => (await import("../avatar/load")).loadAvatar(data),
    show: (a) => void loop.setAvatar(a),
    notify: (level, words) => toasts.show(level, words),
    remember: (id) => {
      settings.avatar = id;
      save();
    },
  },
  settings.avatar,
);
const outputs = new OutputList(send, (words) => toasts.show("warning", words));
const recordings = new Recordings(send, announce);
const panel = new Panel(settings, save);
const guide = new Guide(
  send,
  announce,
  (guiding) => (byId("main", HTMLElement).dataset.layout = guiding ? "guide" : "live"),
);

let phase: Phase | "connecting" | "disconnected" = "connecting";
let lastPose: Pose | null = null;
let isCamera = false;
const program = new VersionWatch();
const counters = { poses: 0, lost: 0, pictures: 0 };

const enable = (id: string, on: boolean): void => void (byId(id, HTMLButtonElement).disabled = !on);

function onStatus(s: Status): void {
  phase = s.phase;
  line.setStatus(s);
  gauges.setStatus(s);
  guide.setStatus(s);
  outputs.setOutputs(s.outputs);
  recordings.setStatus(s);
  const calibrated = s.phase === "tracking" || s.phase === "lost";
  enable("recalibrate", calibrated);
  enable("guide-again", isCamera && s.phase !== "opening" && s.phase !== "ended");
  if (!calibrated) forgetPose();
}

function onPose(p: Pose): void {
  lastPose = p;
  counters[p.state === "tracking" ? "poses" : "lost"]++;
  driver.setPose(p, performance.now() / 1000);
  camera.setPose(p);
  top.setPose(p);
  gauges.setPose(p);
  showAlternative(p.state === "tracking" ? p.secondMode : null);
}

function forgetPose(): void {
  driver.setLost();
  top.setPose(null);
  showAlternative(null);
}

/** The weight of the second most likely pose; below 5 % it is not shown. */
function showAlternative(weight: number | null): void {
  const chip = byId("second-mode", HTMLElement);
  const percent = Math.round((weight ?? 0) * 100);
  chip.hidden = percent < 5;
  chip.classList.toggle("strong", percent >= 25);
  setText(chip, `Alternative pose: ${percent} %`);
}

function onMessage(m: Incoming): void {
  switch (m.type) {
    case "hello":
      if (m.protocol !== PROTOCOL)
        toasts.show("error", "This page and the program have different versions. Reload the page.");
      else if (program.changed(m.version)) toasts.show("warning", "Telemime was updated. Reload the page.");
      isCamera = m.live;
      document.title = m.input ? `Telemime · ${m.input}` : "Telemime";
      camera.setCamera(m.camera);
      top.setCamera(m.camera);
      if (m.camera) {
        const main = byId("main", HTMLElement);
        main.style.setProperty("--picture", String(m.camera.width / m.camera.height));
      }
      outputs.setSenders(m.senders);
      void avatars.setLooks(m.looks);
      break;
    case "body":
      driver.setBody(m);
      break;
    case "pose":
      onPose(m);
      break;
    case "status":
      onStatus(m);
      break;
    case "message":
      if (m.level !== "error" || !outputs.refused(m.words)) toasts.show(m.level, m.words);
      break;
    case "pong":
      break;
  }
}

function onConnection(s: ConnectionState): void {
  banner.setState(s);
  if (s.kind === "open") subscribe();
  if (s.kind !== "lost") return;
  phase = "disconnected";
  forgetPose();
  for (const part of [line, gauges, guide, outputs, recordings]) part.disconnected();
  for (const id of ["recalibrate", "guide-again"]) enable(id, false);
}

/** A hidden page gets neither pictures nor poses. */
function subscribe(): void {
  const on = !document.hidden;
  send({ type: "pictures", on });
  send({ type: "poses", on });
}
document.addEventListener("visibilitychange", () => {
  if (!document.hidden) driver.resume(performance.now() / 1000);
  subscribe();
});

const address = `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/ws`;
const connection: Connection = new Connection(address, {
  message: onMessage,
  picture: (p) => {
    counters.pictures++;
    byId("camera-none", HTMLElement).hidden = true;
    void camera.setPicture(p);
  },
  state: onConnection,
});

/** Switches: the button, the setting, and what is announced. */
const SWITCHES = [
  { id: "mirror-avatar", setting: "mirrorAvatar", name: "Mirrored avatar" },
  { id: "mirror-picture", setting: "mirrorPicture", name: "Mirrored video" },
  { id: "overlay", setting: "overlay", name: "Skeleton overlay" },
  { id: "close-up", setting: "closeUp", name: "Close-up of the top view" },
] as const;

function apply(): void {
  driver.mirrored = settings.mirrorAvatar;
  camera.mirrored = settings.mirrorPicture;
  top.mirrored = settings.mirrorPicture;
  camera.overlay = settings.overlay;
  top.close = settings.closeUp;
  camera.refresh();
  top.refresh();
  for (const { id, setting } of SWITCHES)
    byId(id, HTMLButtonElement).setAttribute("aria-pressed", String(settings[setting]));
}

const toggles = SWITCHES.map(({ id, setting, name }) => {
  const toggle = () => {
    settings[setting] = !settings[setting];
    save();
    apply();
    announce(`${name} ${settings[setting] ? "on" : "off"}.`);
  };
  button(id, toggle);
  return toggle;
});
type Run = () => void;
const [mirrorAvatar, mirrorPicture, overlay, closeUp] = toggles as [Run, Run, Run, Run];
const resetView = () => loop.resetView();
button("reset-view", resetView);
button("recalibrate", () => send({ type: "recalibrate" }));
button("guide-again", () => guide.again());
/** As the button, which may be disabled. */
const press = (id: string) => () => byId(id, HTMLButtonElement).click();

new Shortcuts(
  [
    { key: "m", label: "Mirror the avatar", run: mirrorAvatar },
    { key: "M", label: "Mirror the video", run: mirrorPicture },
    { key: "v", label: "Show the avatar from the front", run: resetView },
    { key: "r", label: "Start or stop recording", run: () => recordings.toggle() },
    { key: "c", label: "Recalibrate: measure my body again", run: press("recalibrate") },
    { key: "g", label: "Restart the guided setup", run: press("guide-again") },
    { key: "e", label: "Background: start or stop the countdown", run: () => guide.toggleCountdown() },
    { key: "s", label: "Background: skip", run: () => guide.skip() },
    { key: "o", label: "Draw the tracked skeleton on the video", run: overlay },
    { key: "z", label: "Top view: close-up", run: closeUp },
    { key: "p", label: "Side panel", run: () => panel.toggle() },
    { key: "1", label: "Side panel: avatars", run: () => panel.show("avatar") },
    { key: "2", label: "Side panel: send", run: () => panel.show("send") },
    { key: "3", label: "Side panel: recordings", run: () => panel.show("recordings") },
  ],
  settings,
  save,
  [
    ["Arrow keys", "Turn the avatar (when its view has the focus)"],
    ["+ and -", "Move closer or farther"],
  ],
);

window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", apply);
const reducedMotion = window.matchMedia("(prefers-reduced-motion: reduce)");
const setStill = () => (driver.still = reducedMotion.matches);
reducedMotion.addEventListener("change", setStill);
setStill();
apply();
loop.start();

exposeDebug({
  get phase() {
    return phase;
  },
  get lastPose() {
    return plain(lastPose);
  },
  get avatar() {
    return avatars.info && { ...avatars.info };
  },
  get counters() {
    return { ...counters, ...loop.counters, misunderstood: connection.misunderstood, ...camera.counters };
  },
  boneRotations: () => loop.avatar?.read() ?? {},
  expressions: () => loop.avatar?.face.read() ?? {},
});
