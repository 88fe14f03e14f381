// SPDX-License-Identifier: Apache-2.0
// The destinations of the motion: a list with their states, and a form to add one by its address.

import type { Command, Output, Sender } from "../live/protocol";
import { byId, h, renderOnce, setCount } from "../shared/dom";
import { trashButton } from "../shared/icons";

const ANSWER_TIME = 3000; // ms in which the program reports an error of an address
const NO_CONNECTION = "There is no connection to Telemime.";
const LOOKS_LIKE_URL = /^[a-z][a-z0-9+.-]*:\/\/\S+$/i;

const MAX_ADDRESS = 2000; // characters, the limit of the program

/**
 * An output that has not failed for so long has recovered, ms: the program tries again within 5 s, and a try by UDP counts as
 * sending until it fails.
 */
const RECOVERED = 10_000;

/**
 * The address as the program shows it: without a user's password, or the secret of a meeting's link.
 * The same as without_password in src/telemime/streaming/url.cpp.
 */
export function withoutPassword(given: string): string {
  const secret = given.indexOf(/^http/i.test(given) ? "#" : "#k=");
  const url = secret < 0 ? given : given.slice(0, secret);
  const scheme = url.indexOf("://");
  if (scheme < 0) return url;
  const start = scheme + 3;
  const behind = url.slice(start).search(/[/?#]/);
  const end = behind < 0 ? url.length : start + behind;
  const colon = url.indexOf(":", start);
  let at = url.slice(0, end).lastIndexOf("@");
  if (at < start) {
    // There is no user before the host. A password that contains "/" ends behind it.
    const hostAndPath = colon < 0 || colon > end || /^[0-9]+$/.test(url.slice(colon + 1, end));
    at = hostAndPath && !/^mqtt/i.test(url) ? -1 : url.lastIndexOf("@");
  }
  return at < 0 || colon < 0 || colon > at ? url : url.slice(0, colon) + url.slice(at);
}

/** Class of the dot: states that this page does not know count as waiting. */
function dotClass(o: Output): "good" | "bad" | "wait" | "" {
  return o.state === "sending" ? "good" : o.state === "failed" ? "bad" : o.state ? "wait" : "";
}

function counters(o: Output): string {
  const parts = [`${o.sent} sent`];
  if (o.dropped > 0) parts.push(`${o.dropped} dropped`);
  if (o.receivers !== null) parts.push(o.receivers === 1 ? "1 receiver" : `${o.receivers} receivers`);
  return parts.join(" · ");
}

export class OutputList {
  private readonly list = byId("outputs", HTMLElement);
  private readonly input = byId("output-url", HTMLInputElement);
  private readonly error = byId("output-error", HTMLElement);
  private outputs: readonly Output[] = [];
  private connected = false;
  /** The address that was added last, until the list or an error answers it. */
  private pending: { url: string; shown: string; at: number } | null = null;

  /** When the failing outputs failed last, by address. */
  private readonly failed = new Map<string, number>();

  /** `warn` tells the user that an output fails. */
  constructor(
    private readonly send: (c: Command) => boolean,
    private readonly warn: (words: string) => void,
  ) {
    byId("output-form", HTMLFormElement).addEventListener("submit", (e) => {
      e.preventDefault();
      this.add();
    });
    this.input.addEventListener("input", () => this.showError(""));
  }

  setSenders(senders: readonly Sender[]): void {
    byId("output-examples", HTMLElement).replaceChildren(
      ...senders.map(({ example, summary }) => {
        const onclick = () => {
          this.input.value = example;
          this.showError("");
          this.input.focus();
        };
        const content = [h("code", {}, example), h("span", {}, summary)];
        return h("li", {}, h("button", { type: "button", class: "example", onclick }, ...content));
      }),
    );
  }

  setOutputs(outputs: readonly Output[]): void {
    const { pending } = this;
    const active = (all: readonly Output[]) => all.some((o) => o.url === pending?.shown && o.state !== "off");
    // An address that was in the list before is not an answer: its error is still to come.
    if (active(outputs) && !active(this.outputs)) this.pending = null;
    if (this.error.textContent === NO_CONNECTION) this.showError("");
    this.connected = true;
    this.outputs = outputs;
    this.watch();
    this.show();
  }

  /** Warns of outputs that fail, once until they have recovered. */
  private watch(): void {
    const now = performance.now();
    const on = new Set(this.outputs.filter((o) => o.state !== "off").map((o) => o.url));
    for (const [url, at] of this.failed) if (!on.has(url) || now - at > RECOVERED) this.failed.delete(url);
    for (const { url, state, words } of this.outputs) {
      if (state !== "failed") continue;
      if (!this.failed.has(url)) this.warn(`${url}: ${words || state}.`);
      this.failed.set(url, now);
    }
  }

  /** The states are unknown until the next status. */
  disconnected(): void {
    this.connected = false;
    this.pending = null;
    this.failed.clear();
    this.show();
  }

  private show(): void {
    const outputs = this.connected
      ? this.outputs
      : this.outputs.map((o) => ({ ...o, state: "", words: "not connected" }));
    byId("outputs-empty", HTMLElement).hidden = outputs.length > 0;
    setCount("send", outputs.length, this.failed.size > 0);
    renderOnce(this.list, outputs.map((o) => `${o.url} ${o.state} ${o.words}`).join("\n"), () =>
      outputs.map((o) => {
        const remove = () => this.ask({ type: "output", remove: o.url });
        const off = o.state === "off";
        const name = off ? "Resume" : "Pause";
        const toggle = {
          class: "small",
          "aria-label": `${name} ${o.url}`,
          "data-focus": `toggle ${o.url}`,
          onclick: () => this.ask(off ? { type: "output", add: o.url } : { type: "output", off: o.url }),
        };
        return h(
          "li",
          { class: "row" },
          h("span", { class: `dot ${dotClass(o)}`.trim() }),
          h(
            "div",
            { class: "row-text" },
            h("b", { class: "url" }, o.url),
            h("span", { class: "state-words" }, [o.state, o.words].filter(Boolean).join(": ")),
            h("span", { class: "soft", "data-counters": "" }, ""),
          ),
          h("button", toggle, name),
          trashButton(`Remove ${o.url}`, remove, { "data-focus": o.url }),
        );
      }),
    );
    // The counters change all the time: only their text is replaced.
    this.list.querySelectorAll("[data-counters]").forEach((e, i) => {
      const o = outputs[i];
      if (o) e.textContent = this.connected ? counters(o) : "";
    });
  }

  private ask(c: Command): void {
    if (!this.send(c)) this.error.textContent = NO_CONNECTION;
  }

  private add(): void {
    const url = this.input.value.trim();
    if (!LOOKS_LIKE_URL.test(url)) {
      this.showError("An address looks like vmc://localhost:39539. Choose an example and edit it.");
      return;
    }
    if (url.length > MAX_ADDRESS) {
      this.showError(`An address has at most ${MAX_ADDRESS} characters.`);
      return;
    }
    if (this.send({ type: "output", add: url })) {
      this.pending = { url, shown: withoutPassword(url), at: performance.now() };
      this.input.value = "";
      this.showError("");
    } else {
      this.showError(NO_CONNECTION);
    }
  }

  /** Takes an error of the program: true when it answers the pending address and is now shown beside it. */
  refused(words: string): boolean {
    const pending = this.pending;
    if (!pending || performance.now() - pending.at > ANSWER_TIME) return false;
    if (!words.includes(pending.shown)) return false; // another error, for instance a full disk
    this.pending = null;
    this.input.value ||= pending.url;
    this.showError(words);
    return true;
  }

  private showError(words: string): void {
    this.error.textContent = words;
    this.input.setAttribute("aria-invalid", String(Boolean(words)));
  }
}
