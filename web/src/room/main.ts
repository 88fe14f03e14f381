// SPDX-License-Identifier: Apache-2.0
// The room's page: joins the door, the room and its pictures.

import { Banner } from "../ui/banner";
import { button, byId } from "../ui/dom";
import { Panel } from "../ui/panel";
import { Shortcuts } from "../ui/shortcuts";
import { Toasts } from "../ui/toasts";
import { exposeRoom } from "./debug";
import { EntryError, enter, inviteOf, loadKept, saveKept, tokenFor, withSeat, type Entered } from "./entry";
import type { Dial, LinkState } from "./link";
import type { Me, MyState } from "./me";
import { plainLine } from "./names";
import { Rig, VIEWS, type View } from "./rig";
import { RoomClient, type RoomListener } from "./room_client";
import { Roster } from "./roster";
import { loadRoomSettings, saveRoomSettings } from "./settings";
import { SceneUi } from "./scene/ui";
import { trackerCommand } from "./tracker_command";
import { BoardView } from "./ui/board_view";
import { ChatView } from "./ui/chat_view";
import { Door, type Wish } from "./ui/door";
import { People } from "./ui/people";
import { RoomTab } from "./ui/room_tab";
import { StatusLine } from "./ui/status";

// The secret of the link leaves the address bar before anything else happens.
let invite = inviteOf(location.hash);
const tidy = (): void => history.replaceState(null, "", location.pathname + location.search);
if (location.hash) tidy();

let kept = loadKept();
const settings = loadRoomSettings();
const toasts = new Toasts();
const status = new StatusLine();
const rig = new Rig();
const nobody = new Roster("r/none/none");
const calm = window.matchMedia("(prefers-reduced-motion: reduce)");
let client: RoomClient | null = null;
let wish: Wish | null = null;
/** The library for MQTT comes when it is needed. */
let brokerDial: ((entered: Entered, will: Me["will"] | null) => Dial) | null = null;

const keepSettings = (): void => {
  saveRoomSettings(settings);
  chat?.seen(chatIsOpen());
};
const chatIsOpen = (): boolean =>
  settings.tab === "chat" && document.body.dataset.panel === "open" && document.body.dataset.stage === "room";

const people = new People();
const chat = new ChatView((text) => client?.say(text) ?? "You are not in the room.");
const roomTab = new RoomTab({
  alter: async (change) => (await client?.alter(change)) ?? "You are not in the room.",
  command: () => (client ? trackerCommand(client.entered, client.me?.state ?? null) : null),
  announce: (words) => status.announce(words),
});
const banner = new Banner(() => client?.tryNow());
const panel = new Panel(settings, keepSettings);
const scene = new SceneUi(
  rig,
  () => ({
    roster: client?.roster ?? nobody,
    me: client?.me?.id ?? null,
    covered: boardView.open,
  }),
  () => client?.board.strokes ?? [],
  () => boardView.refresh(),
);
const boardView: BoardView = new BoardView({
  picture: scene.slate.canvas,
  draw: (colour, width, way) => client?.draw(colour, width, way) ?? false,
  undo: () => client?.undo() ?? false,
  wipe: () => client?.wipe(),
  announce: (words) => status.announce(words),
  opened: () => scene.touch(),
});
scene.open((words) => toasts.say("error", words));

function showPeople(): void {
  const c = client;
  if (!c) return;
  const now = performance.now() / 1000;
  const names = c.roster.names;
  people.details = settings.details;
  people.show(
    c.roster.here.map((p) => ({
      id: p.id,
      name: names.get(p.id) ?? p.id,
      me: p.id === c.me?.id,
      chair: c.roster.room.chairs.includes(p.id),
      tracker: p.state?.kind !== "browser",
      reading: p.stream.reading(now),
      refused: p.refused,
      complaint: scene.cast?.complaint(p.id) ?? "",
    })),
  );
}
window.setInterval(showPeople, 500);

function showStatus(): void {
  if (!client) return;
  const title = plainLine(client.roster.room.title, 60);
  byId("title", HTMLElement).textContent = title || "Telemime";
  document.title = title ? `${title} · Telemime` : "Room · Telemime";
  status.show(client.state, client.roster.here.length, client.me, client.roster.room.locked);
  if (client.settled) roomTab.show(client.roster.room);
  roomTab.tracked(client.me?.other?.kind === "tracker");
  chat.waiting(client.state.kind === "open" ? 0 : client.outbox.waiting.length);
}

function linked(s: LinkState): void {
  banner.setState(s.kind === "lost" ? s : s.kind === "connecting" ? s : { kind: "open" });
  showStatus();
  if (s.kind === "refused") void comeBack(s.words);
}

/** The broker does not take the key any more: the room's program may give another one. Once, then the door opens. */
let backAt = -Infinity;
async function comeBack(words: string): Promise<void> {
  const old = client;
  if (!old || !wish) return;
  if (performance.now() < backAt + 10000) {
    leave(`${words} Enter again.`);
    return;
  }
  backAt = performance.now();
  try {
    const entered = await ask(wish.watch);
    if (client === old) start(entered, old.me?.state.seat ?? null);
  } catch (e) {
    if (client === old) leave(`${words} ${e instanceof EntryError ? e.message : ""}`.trim());
  }
}

async function ask(watch: boolean): Promise<Entered> {
  brokerDial ??= (await import("./broker")).brokerDial;
  const entered = await enter({ invite, token: watch ? null : tokenFor(kept, invite), watch });
  kept = withSeat(kept, invite, entered);
  saveKept(kept);
  return entered;
}

async function come(w: Wish): Promise<void> {
  const entered = await ask(w.watch);
  wish = w;
  start(entered, null);
  door.close();
  document.body.dataset.stage = "room";
  chat.seen(chatIsOpen());
  byId("room-canvas", HTMLCanvasElement).focus();
  if (!w.watch && !entered.participant)
    toasts.say("info", "With this link you can watch, but not take part.");
}

/** What was written and is not on its way any more is told: the chat does not show it. */
function tellUnsaid(c: RoomClient | null): void {
  const n = c?.outbox.waiting.length ?? 0;
  if (n) toasts.say("warning", n === 1 ? "One message was not sent." : `${n} messages were not sent.`);
}

function start(entered: Entered, seat: number | null): void {
  const before = client?.outbox;
  client?.stop();
  scene.cast?.clear();
  const state: MyState | null = wish!.watch ? null : { name: wish!.name, avatar: wish!.avatar, seat };
  const listener: RoomListener = {
    link: (s) => c === client && linked(s),
    event: (e) => {
      if (e.kind !== "said" && e.kind !== "page") scene.follow(c.roster, c.me?.id ?? null);
      if (e.kind === "came" || e.kind === "left") {
        showPeople();
        showStatus();
      }
      if (e.kind === "room") showStatus();
    },
    line: (l) => {
      chat.add(l);
      if (l.kind === "said") scene.say(l.from, l.text);
      else status.announce(l.text);
    },
    strokes: (s) => scene.slate.add(s),
    mine: showStatus,
  };
  const c: RoomClient = new RoomClient(
    entered,
    state,
    (will) => brokerDial!(entered, will),
    listener,
    before,
  );
  if (!c.me) tellUnsaid(c);
  client = c;
  scene.slate.add(null);
  chat.enable(c.me !== null);
  boardView.allow(c.mayDraw, c.mayChair);
  const mine = c.me?.state ?? null;
  const look = mine?.avatar ?? {};
  roomTab.enter(c.mayChair, trackerCommand(entered, mine) !== null, "look" in look);
  for (const radio of document.querySelectorAll<HTMLInputElement>('input[name="view"]'))
    radio.disabled = radio.value !== "orbit" && c.me === null;
  if (!c.me) setView("orbit");
  c.start();
}

/** Back to the door. */
function leave(words: string): void {
  tellUnsaid(client);
  client?.leave();
  client = null;
  scene.cast?.clear();
  boardView.toggle(false);
  boardView.allow(false, false);
  roomTab.enter(false, false, false);
  chat.clear();
  people.show([]);
  banner.setState({ kind: "open" });
  status.door();
  setView("orbit");
  scene.slate.add(null);
  document.body.dataset.stage = "door";
  door.open(words, true);
}

const door: Door = new Door(kept, come, (name, avatar) => {
  kept = { ...kept, name, avatar };
  saveKept(kept);
});

function setView(view: View): void {
  const radio = document.querySelector<HTMLInputElement>(`input[name="view"][value="${view}"]`);
  if (!radio || radio.disabled) return;
  radio.checked = true;
  rig.setView(view);
  scene.touch();
}
for (const radio of document.querySelectorAll<HTMLInputElement>('input[name="view"]'))
  radio.addEventListener("change", () => setView(radio.value as View));
const resetView = (): void => {
  rig.reset();
  scene.touch();
};
button("reset-view", resetView);
button("leave", () => leave("You have left the room."));

const inRoom = (run: () => void) => () => {
  if (client) run();
};
new Shortcuts(
  [
    ...VIEWS.map((view, i) => ({
      key: String(i + 1),
      label: ["View: the whole room", "View: from your seat", "View: from your avatar's eyes"][i]!,
      run: inRoom(() => setView(view)),
    })),
    { key: "v", label: "The usual view", run: resetView },
    { key: "b", label: "Blackboard", run: inRoom(() => boardView.toggle()) },
    { key: "z", label: "Take your last line on the blackboard back", run: inRoom(() => boardView.undo()) },
    { key: "p", label: "Side panel", run: inRoom(() => panel.toggle()) },
    { key: "w", label: "Side panel: who is here", run: inRoom(() => panel.show("people")) },
    { key: "r", label: "Side panel: the room and your camera", run: inRoom(() => panel.show("room")) },
    {
      key: "c",
      label: "Side panel: chat",
      run: inRoom(() => {
        panel.show("chat");
        chat.focus();
      }),
    },
  ],
  {
    get: () => settings.keys,
    set: (on) => {
      settings.keys = on;
      keepSettings();
    },
  },
  [
    ["Arrow keys", "Turn the view, or move the chalk (when room or board has the focus)"],
    ["+ and -", "Closer, farther"],
    ["Space", "Chalk down or up (when the board has the focus)"],
  ],
);
document.addEventListener("keydown", (e) => {
  if (e.key === "Escape" && boardView.open && !document.querySelector("dialog[open]"))
    boardView.toggle(false);
});

function box(id: string, key: "strangers" | "details", changed: () => void): void {
  const input = byId(id, HTMLInputElement);
  input.checked = settings[key];
  input.addEventListener("change", () => {
    settings[key] = input.checked;
    keepSettings();
    changed();
  });
}
const setStrangers = (): void => {
  scene.strangers(settings.strangers);
  if (client) scene.follow(client.roster, client.me?.id ?? null);
};
box("strangers", "strangers", setStrangers);
box("details", "details", showPeople);
setStrangers();
const setCalm = (): void => scene.still(calm.matches);
calm.addEventListener("change", setCalm);
setCalm();

window.addEventListener("hashchange", () => {
  const other = inviteOf(location.hash);
  if (location.hash) tidy();
  if (!other) return;
  invite = other;
  if (client) leave("");
  else door.open("", true);
});
window.addEventListener("pagehide", () => client?.leave());
window.addEventListener("pageshow", (e) => {
  if (e.persisted && client) leave("Welcome back: enter again.");
});
window.addEventListener("online", () => client?.tryNow());

const known = invite !== null || kept.seats.length > 0;
door.open(known ? "" : "This page needs a link to a room: ask whoever runs it.", known);

exposeRoom({
  get phase() {
    return client?.state.kind ?? "door";
  },
  get settled() {
    return client?.settled ?? false;
  },
  get me() {
    return client?.me?.id ?? null;
  },
  get participants() {
    const c = client;
    if (!c) return [];
    const seats = c.roster.seats;
    const now = performance.now() / 1000;
    return c.roster.here.map((p) => ({
      id: p.id,
      name: c.nameOf(p.id),
      seat: seats.get(p.id) ?? -1,
      kind: p.state?.kind ?? null,
      dressed: scene.cast?.dressed(p.id) ?? false,
      complaint: scene.cast?.complaint(p.id) ?? "",
      refused: p.refused,
      reading: p.stream.reading(now),
    }));
  },
  get poses() {
    return client ? scene.poses(client.roster) : {};
  },
  get strokes() {
    return client?.board.strokes ?? [];
  },
  get counters() {
    return {
      ...scene.counters,
      ignored: client?.roster.ignored ?? 0,
      flooded: client?.log.flooded ?? 0,
      crowded: client?.board.crowded ?? 0,
      waiting: client?.outbox.waiting.length ?? 0,
    };
  },
  boneRotations: (id) => scene.cast?.read(id) ?? {},
});
