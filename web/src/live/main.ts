// SPDX-License-Identifier: Apache-2.0
// The live page: joins the connection, the views and the controls.

import { PoseDriver } from "../avatar/driver";
import { Connection } from "../connection";
import { drawsInSoftware } from "../graphics";
import { PROTOCOL, type Command, type Incoming, type Phase, type Pose, type Status } from "../protocol";
import { Avatars } from "../ui/avatars";
import { Banner } from "../ui/banner";
import { button, byId } from "../ui/dom";
import { Guide } from "../ui/guide";
import { OutputList } from "../ui/outputs";
import { Panel } from "../ui/panel";
import { Recordings } from "../ui/recordings";
import { loadSettings, saveSettings, type Settings } from "../ui/settings";
import { Shortcuts } from "../ui/shortcuts";
import { StateLine } from "../ui/state";
import { Toasts } from "../ui/toasts";
import { CameraView, fewerPictures } from "../views/camera";
import { Gauges } from "../views/gauges";
import { TopView } from "../views/top";
import { exposeDebug } from "./debug";
import { Loop } from "./loop";

const settings: Settings = loadSettings();
let kept: Settings = { ...settings };
const keep = () => {
  saveSettings(settings, kept);
  kept = { ...settings };
};

const send = (c: Command): boolean => connection.send(c);
const driver = new PoseDriver();
const camera = new CameraView(byId("camera-canvas", HTMLCanvasElement));
const top = new TopView(byId("top-canvas", HTMLCanvasElement));
const gauges = new Gauges();
const toasts = new Toasts();
const line = new StateLine();
const banner = new Banner(() => connection.tryNow());
const loop = new Loop(driver, camera, top, send, (words) => toasts.say("error", words));

const avatars = new Avatars(
  {
    // The 3-D library is the largest part of the page: loaded beside the first words of the program.
    load: async (data) => (await import("../avatar/load")).loadAvatar(data),
    show: (a) => loop.setAvatar(a),
    say: (level, words) => toasts.say(level, words),
    remember: (id) => {
      settings.avatar = id;
      keep();
    },
  },
  settings.avatar,
);
const outputs = new OutputList(send);
const recordings = new Recordings(send, (w) => line.announce(w));
const panel = new Panel(settings, keep);
const guide = new Guide(
  send,
  (w) => line.announce(w),
  (guiding) => (byId("main", HTMLElement).dataset.layout = guiding ? "guide" : "live"),
);

let phase: Phase | "connecting" | "disconnected" = "connecting";
let lastPose: Pose | null = null;
let fps: Status["fps"] = { input: null, tracked: null };
let half = false; // of the pictures are asked for
const counters = { poses: 0, lost: 0, pictures: 0 };

function onStatus(s: Status): void {
  phase = s.phase;
  fps = s.fps;
  if (fewerPictures(drawsInSoftware(), fps, half) !== half) look(!document.hidden);
  line.setStatus(s);
  gauges.setStatus(s);
  guide.setStatus(s);
  outputs.setOutputs(s.outputs);
  recordings.setStatus(s);
  const calibrated = s.phase === "tracking" || s.phase === "lost";
  byId("recalibrate", HTMLButtonElement).disabled = !calibrated;
  byId("guide-again", HTMLButtonElement).disabled = s.phase === "opening" || s.phase === "ended";
  if (!calibrated) {
    driver.setLost();
    top.setPose(null);
    secondMode(null);
  }
}

function onPose(p: Pose): void {
  lastPose = p;
  counters[p.state === "tracking" ? "poses" : "lost"]++;
  driver.setPose(p, performance.now() / 1000);
  camera.setPose(p);
  top.setPose(p);
  gauges.setPose(p);
  secondMode(p.state === "tracking" ? p.secondMode : null);
}

/** The tracker keeps several readings of the picture; a strong second one is worth a word. */
function secondMode(weight: number | null): void {
  const chip = byId("second-mode", HTMLElement);
  const percent = Math.round((weight ?? 0) * 100);
  chip.hidden = percent < 5;
  chip.classList.toggle("strong", percent >= 25);
  const words = `${percent} % other reading`;
  if (chip.textContent !== words) chip.textContent = words;
}

function onMessage(m: Incoming): void {
  switch (m.type) {
    case "hello":
      if (m.protocol !== PROTOCOL) {
        toasts.say("error", "This page and the program do not fit together. Load the page again.");
      }
      document.title = m.input ? `Telemime · ${m.input}` : "Telemime";
      camera.setCamera(m.camera);
      top.setCamera(m.camera);
      if (m.camera) {
        const box = byId("main", HTMLElement);
        box.style.setProperty("--picture", String(m.camera.width / m.camera.height));
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
      if (m.level !== "error" || !outputs.refused(m.words)) toasts.say(m.level, m.words);
      break;
    case "pong":
      break;
  }
}

const address = `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/ws`;
const connection: Connection = new Connection(address, {
  message: onMessage,
  picture: (p) => {
    counters.pictures++;
    byId("camera-none", HTMLElement).hidden = true;
    void camera.setPicture(p);
  },
  state: (s) => {
    banner.setState(s);
    if (s.kind === "open") look(!document.hidden);
    if (s.kind !== "lost") return;
    phase = "disconnected";
    driver.setLost();
    top.setPose(null);
    secondMode(null);
    line.disconnected();
    gauges.disconnected();
    guide.disconnected();
    outputs.disconnected();
    recordings.disconnected();
    for (const id of ["recalibrate", "guide-again"]) byId(id, HTMLButtonElement).disabled = true;
  },
});

/** Nothing is made for pages that nobody sees. */
function look(on: boolean): void {
  half = fewerPictures(drawsInSoftware(), fps, half);
  send({ type: "pictures", on, half });
  send({ type: "poses", on });
}
document.addEventListener("visibilitychange", () => look(!document.hidden));

// Controls.
type Switch = "mirrorPicture" | "mirrorAvatar" | "overlay" | "closeUp";
function apply(): void {
  driver.mirrored = settings.mirrorAvatar;
  camera.mirrored = settings.mirrorPicture;
  top.mirrored = settings.mirrorPicture;
  camera.overlay = settings.overlay;
  top.close = settings.closeUp;
  camera.refresh();
  top.refresh();
  const pressed: [string, boolean][] = [
    ["mirror-avatar", settings.mirrorAvatar],
    ["mirror-picture", settings.mirrorPicture],
    ["overlay", settings.overlay],
    ["close-up", settings.closeUp],
  ];
  for (const [id, on] of pressed) byId(id, HTMLButtonElement).setAttribute("aria-pressed", String(on));
}

function flip(key: Switch, name: string): void {
  settings[key] = !settings[key];
  keep();
  apply();
  line.announce(`${name} ${settings[key] ? "on" : "off"}.`);
}

const mirrorAvatar = () => flip("mirrorAvatar", "Mirrored avatar");
const mirrorPicture = () => flip("mirrorPicture", "Mirrored picture");
const overlay = () => flip("overlay", "Tracked body in the picture");
const closeUp = () => flip("closeUp", "Closer look from above");
const resetView = () => loop.resetView();
const recalibrate = () => {
  if (!byId("recalibrate", HTMLButtonElement).disabled) send({ type: "recalibrate" });
};
const again = () => {
  if (!byId("guide-again", HTMLButtonElement).disabled) guide.again();
};
button("mirror-avatar", mirrorAvatar);
button("mirror-picture", mirrorPicture);
button("overlay", overlay);
button("close-up", closeUp);
button("reset-view", resetView);
button("recalibrate", recalibrate);
button("guide-again", again);

new Shortcuts(
  [
    { key: "m", label: "Mirror the avatar", run: mirrorAvatar },
    { key: "M", label: "Mirror the camera picture", run: mirrorPicture },
    { key: "v", label: "Look at the avatar from the front", run: resetView },
    { key: "r", label: "Start or stop a recording", run: () => recordings.toggle() },
    { key: "c", label: "Recalibrate: measure me anew", run: recalibrate },
    { key: "g", label: "Guide me through the start again", run: again },
    { key: "e", label: "Empty room: start or stop the countdown", run: () => guide.toggleCount() },
    { key: "s", label: "Skip the empty room", run: () => guide.skip() },
    { key: "o", label: "Draw the tracked body in the picture", run: overlay },
    { key: "z", label: "Closer look from above", run: closeUp },
    { key: "p", label: "Side panel", run: () => panel.toggle() },
    { key: "1", label: "Side panel: avatars", run: () => panel.show("avatar") },
    { key: "2", label: "Side panel: send", run: () => panel.show("send") },
    { key: "3", label: "Side panel: recordings", run: () => panel.show("recordings") },
  ],
  {
    get: () => settings.keys,
    set: (on) => {
      settings.keys = on;
      keep();
    },
  },
);

const dark = window.matchMedia("(prefers-color-scheme: dark)");
dark.addEventListener("change", apply);
const calm = window.matchMedia("(prefers-reduced-motion: reduce)");
const setCalm = () => (driver.still = calm.matches);
calm.addEventListener("change", setCalm);
setCalm();
apply();
loop.start();

exposeDebug({
  phase: () => phase,
  lastPose: () => lastPose,
  avatar: () => avatars.info,
  read: () => loop.avatar?.read() ?? {},
  counters: () => ({
    ...counters,
    ...loop.counters,
    misunderstood: connection.misunderstood,
    ...camera.counters,
  }),
});
