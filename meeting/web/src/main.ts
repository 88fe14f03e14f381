// SPDX-License-Identifier: Apache-2.0
// The meeting's page: connects the entry form, the meeting and its scene.

import { button, byId } from "#web/shared/dom";
import { buildFrame } from "#web/shared/frame";
import { Banner, Toasts } from "#web/shared/notices";
import { Panel } from "#web/shared/panel";
import { Pause, retryDelay } from "#web/shared/retry";
import { Shortcuts } from "#web/shared/shortcuts";
import { exposeMeeting } from "./debug";
import {
  EntryError,
  enterStored,
  inviteOf,
  inviteOfTab,
  storedEntry,
  trackerCommand,
  untilAnswered,
  type Entered,
} from "./entry";
import type { Dial, LinkState } from "./link";
import type { LocalParticipant, OwnState } from "./local_participant";
import { plainLine } from "./names";
import { Rig, VIEWS, type View } from "./rig";
import { MeetingClient, type MeetingListener } from "./meeting_client";
import { Roster } from "./roster";
import { storedSettings } from "./settings";
import { SceneUi } from "./scene/ui";
import { BoardView } from "./ui/board_view";
import { ChatView } from "./ui/chat_view";
import { EntryForm, type Wish } from "./ui/entry_form";
import { People } from "./ui/people";
import { MeetingTab } from "./ui/meeting_tab";
import { MeetingState } from "./ui/status";

// The secret of the link leaves the address bar before anything else happens.
let invite = inviteOfTab(inviteOf(location.hash));
const tidy = (): void => history.replaceState(null, "", location.pathname + location.search);
if (location.hash) tidy();

buildFrame({
  state: "Not joined",
  note: "To use your own movements, run telemime live on your computer and send them to this meeting.",
});

const entryStore = storedEntry();
const saved = entryStore.load();
const stored = storedSettings();
const settings = stored.load();
const toasts = new Toasts();
const status = new MeetingState();
const rig = new Rig();
const nobody = new Roster("r/none/none");
const calm = window.matchMedia("(prefers-reduced-motion: reduce)");
let client: MeetingClient | null = null;
let wish: Wish | null = null;
/** Leads back to the seat that this page had. */
let token: string | null = null;
/** The MQTT library is loaded when it is needed. */
let brokerDial: ((entered: Entered, will: LocalParticipant["will"] | null) => Dial) | null = null;

const keepSettings = (): void => {
  stored.save(settings);
  chat?.seen(chatIsOpen());
};
const chatIsOpen = (): boolean =>
  settings.tab === "chat" &&
  document.body.dataset.panel === "open" &&
  document.body.dataset.stage === "meeting";

const people = new People();
const chat = new ChatView(
  (text) => client?.write(text) ?? "You have not joined the meeting.",
  (words) => status.announce(words),
);
const meetingTab = new MeetingTab({
  alter: async (change) => (await client?.alter(change)) ?? "You have not joined the meeting.",
  command: () => (client ? trackerCommand(client.entered, client.me?.state ?? null) : null),
  announce: (words) => status.announce(words),
});
const beforeNextTry = new Pause();
function tryNow(): void {
  client?.tryNow();
  beforeNextTry.end();
}
const banner = new Banner(tryNow);
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
  wipe: async () => (await client?.wipe()) ?? "You have not joined the meeting.",
  announce: (words) => status.announce(words),
  opened: () => scene.touch(),
});
scene.open((words) => toasts.show("error", words));

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
      chair: c.roster.meeting.chairs.includes(p.id),
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
  const title = plainLine(client.roster.meeting.title, 60);
  byId("title", HTMLElement).textContent = title || "Telemime";
  document.title = title ? `${title} · Telemime` : "Meeting · Telemime";
  status.update(client.state, client.roster.here.length, client.me, client.roster.meeting.locked);
  if (client.settled) meetingTab.show(client.roster.meeting);
  meetingTab.tracked(client.me?.other?.kind === "tracker");
  chat.waiting(client.state.kind === "open" ? 0 : client.outbox.waiting.length);
}

function linked(s: LinkState): void {
  banner.setState(s.kind === "lost" ? s : s.kind === "connecting" ? s : { kind: "open" });
  showStatus();
  if (client && s.kind === "open") scene.cast?.retry(client.roster);
  if (s.kind === "refused") void comeBack(s.words);
}

/** The broker refuses the account: gets another one from the server, once in 10 s, or else shows the entry form. */
let backAt = -Infinity;
async function comeBack(words: string): Promise<void> {
  const old = client;
  const watch = wish?.watch;
  if (!old || watch === undefined) return;
  if (performance.now() < backAt + 10000) {
    leave(`${words} Join again.`);
    return;
  }
  const pause = async (n: number): Promise<boolean> => {
    if (client !== old) return false;
    const ms = retryDelay(n, Math.random());
    banner.setState({ kind: "lost", retryAt: performance.now() + ms, words });
    await beforeNextTry.wait(ms);
    return client === old;
  };
  try {
    const entered = await untilAnswered(() => ask(watch), pause);
    backAt = performance.now();
    if (client === old) start(entered, old.me?.state.seat ?? null);
  } catch (e) {
    if (client === old) leave(`${words} ${e instanceof EntryError ? e.message : ""}`.trim());
  }
}

async function ask(watch: boolean): Promise<Entered> {
  brokerDial ??= (await import("./broker")).brokerDial;
  const entered = await enterStored(entryStore, { invite, token, watch });
  token = entered.token ?? token;
  return entered;
}

async function come(w: Wish): Promise<void> {
  const entered = await ask(w.watch);
  wish = w;
  start(entered, null);
  entryForm.close();
  document.body.dataset.stage = "meeting";
  chat.seen(chatIsOpen());
  byId("meeting-canvas", HTMLCanvasElement).focus();
  if (!w.watch && !entered.participant)
    toasts.show("info", "With this link you can watch, but not participate.");
}

/** Reports messages that will not be sent: the chat does not show them. */
function reportUnsent(c: MeetingClient | null): void {
  const n = c?.outbox.waiting.length ?? 0;
  if (n) toasts.show("warning", n === 1 ? "One message was not sent." : `${n} messages were not sent.`);
}

function start(entered: Entered, seat: number | null): void {
  const before = client?.outbox;
  client?.stop();
  scene.cast?.clear();
  const state: OwnState | null = wish!.watch ? null : { name: wish!.name, avatar: wish!.avatar, seat };
  const listener: MeetingListener = {
    link: (s) => c === client && linked(s),
    event: (e) => {
      if (e.kind !== "said" && e.kind !== "page") scene.follow(c.roster, c.me?.id ?? null);
      if (e.kind === "came" || e.kind === "left") {
        showPeople();
        showStatus();
      }
      if (e.kind === "meeting") showStatus();
    },
    line: (l) => {
      chat.add(l);
      if (l.kind === "said") scene.showMessage(l.from, l.text);
    },
    strokes: (s) => scene.slate.add(s),
    mine: showStatus,
  };
  const c: MeetingClient = new MeetingClient(
    entered,
    state,
    (will) => brokerDial!(entered, will),
    listener,
    before,
  );
  if (!c.me) reportUnsent(c);
  client = c;
  scene.slate.add(null);
  chat.enable(c.me !== null);
  boardView.allow(c.mayDraw, c.mayChair);
  const mine = c.me?.state ?? null;
  const look = mine?.avatar ?? {};
  meetingTab.enter(c.mayChair, trackerCommand(entered, mine) !== null, "look" in look);
  for (const radio of document.querySelectorAll<HTMLInputElement>('input[name="view"]'))
    radio.disabled = radio.value !== "orbit" && c.me === null;
  if (!c.me) setView("orbit");
  c.start();
}

/** Back to the entry form. */
function leave(words: string): void {
  reportUnsent(client);
  client?.leave();
  client = null;
  scene.cast?.clear();
  boardView.toggle(false);
  boardView.allow(false, false);
  meetingTab.enter(false, false, false);
  chat.clear();
  people.show([]);
  banner.setState({ kind: "open" });
  status.entry();
  setView("orbit");
  scene.slate.add(null);
  document.body.dataset.stage = "entry";
  entryForm.open(words, true);
}

const entryForm: EntryForm = new EntryForm(saved, come, (name, avatar) => {
  entryStore.save({ ...entryStore.load(), name, avatar });
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
button("leave", () => leave("You have left the meeting."));

const inMeeting = (run: () => void) => () => {
  if (client) run();
};
new Shortcuts(
  [
    ...VIEWS.map((view, i) => ({
      key: String(i + 1),
      label: ["Overview", "View from your seat", "View from your avatar's eyes"][i]!,
      run: inMeeting(() => setView(view)),
    })),
    { key: "v", label: "Reset the view", run: resetView },
    { key: "b", label: "Blackboard", run: inMeeting(() => boardView.toggle()) },
    { key: "z", label: "Undo your last line on the blackboard", run: inMeeting(() => boardView.undo()) },
    { key: "p", label: "Side panel", run: inMeeting(() => panel.toggle()) },
    { key: "w", label: "Side panel: people", run: inMeeting(() => panel.show("people")) },
    { key: "r", label: "Side panel: meeting and camera", run: inMeeting(() => panel.show("meeting")) },
    {
      key: "c",
      label: "Side panel: chat",
      run: inMeeting(() => {
        panel.show("chat");
        chat.focus();
      }),
    },
  ],
  settings,
  keepSettings,
  [
    ["Arrow keys", "Turn the view, or move the chalk (when scene or board has the focus)"],
    ["+ and -", "Move closer or farther"],
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
  scene.options.strangers = settings.strangers;
  if (client) scene.follow(client.roster, client.me?.id ?? null);
};
box("strangers", "strangers", setStrangers);
box("details", "details", showPeople);
setStrangers();
const setCalm = (): void => void (scene.options.still = calm.matches);
calm.addEventListener("change", setCalm);
setCalm();

window.addEventListener("hashchange", () => {
  const other = inviteOf(location.hash);
  if (location.hash) tidy();
  if (!other) return;
  invite = inviteOfTab(other);
  token = null;
  if (client) leave("");
  else entryForm.open("", true);
});
window.addEventListener("pagehide", () => client?.leave());
window.addEventListener("pageshow", (e) => {
  if (e.persisted && client) leave("Welcome back. Join again to continue.");
});
window.addEventListener("online", tryNow);

const known = invite !== null || saved.seats.length > 0;
entryForm.open(known ? "" : "Open this page with the link of a meeting. Ask its host for one.", known);

exposeMeeting({
  get phase() {
    return client?.state.kind ?? "entry";
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
