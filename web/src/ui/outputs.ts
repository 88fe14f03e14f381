// SPDX-License-Identifier: Apache-2.0
// Where the motion is sent: the list with its state in words, and adding by address.

import type { Command, Output, Sender } from "../protocol";
import { LONGEST_ADDRESS, withoutPassword } from "./address";
import { byId, h, icon, renderOnce } from "./dom";

const ANSWER = 3000; // ms in which the program says what is wrong with an address
const NOBODY = "There is no connection to Telemime at the moment.";
const LOOKS_LIKE_URL = /^[a-z][a-z0-9+.-]*:\/\/\S+$/i;

/** Colour of the dot; a state that this page does not know yet waits, and none at all has none. */
function mood(o: Output): "good" | "bad" | "wait" | "" {
  return o.state === "sending" ? "good" : o.state === "failed" ? "bad" : o.state ? "wait" : "";
}

function facts(o: Output): string {
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
  /** What was added last, until the list or an error answers it. */
  private asked: { url: string; shown: string; at: number } | null = null;

  constructor(private readonly send: (c: Command) => boolean) {
    byId("output-form", HTMLFormElement).addEventListener("submit", (e) => {
      e.preventDefault();
      this.add();
    });
    this.input.addEventListener("input", () => this.complain(""));
  }

  setSenders(senders: readonly Sender[]): void {
    byId("output-examples", HTMLElement).replaceChildren(
      ...senders.map((s) => {
        const b = h(
          "button",
          { type: "button", class: "example" },
          h("code", {}, s.example),
          h("span", {}, s.summary),
        );
        b.addEventListener("click", () => {
          this.input.value = s.example;
          this.complain("");
          this.input.focus();
        });
        return h("li", {}, b);
      }),
    );
  }

  setOutputs(outputs: readonly Output[]): void {
    const { asked } = this;
    const sent = (all: readonly Output[]) => all.some((o) => o.url === asked?.shown && o.state !== "off");
    // One that was there before is no answer: the error that says so is still to come.
    if (sent(outputs) && !sent(this.outputs)) this.asked = null;
    if (this.error.textContent === NOBODY) this.complain("");
    this.connected = true;
    this.outputs = outputs;
    this.show();
  }

  /** How the outputs do is known with the next status. */
  disconnected(): void {
    this.connected = false;
    this.asked = null;
    this.show();
  }

  private show(): void {
    const outputs = this.connected
      ? this.outputs
      : this.outputs.map((o) => ({ ...o, state: "", words: "not connected" }));
    byId("outputs-empty", HTMLElement).hidden = outputs.length > 0;
    byId("count-send", HTMLElement).textContent = outputs.length ? String(outputs.length) : "";
    renderOnce(this.list, outputs.map((o) => `${o.url} ${o.state} ${o.words}`).join("\n"), () =>
      outputs.map((o) => {
        const remove = h(
          "button",
          {
            class: "icon-button",
            "aria-label": `No longer send to ${o.url}`,
            title: "Remove",
            "data-focus": o.url,
          },
          icon("trash"),
        );
        remove.addEventListener("click", () => this.ask({ type: "output", remove: o.url }));
        const off = o.state === "off";
        const flip = h(
          "button",
          {
            class: "small",
            "aria-label": `${off ? "Send again" : "Stop sending"} to ${o.url}`,
            "data-focus": `flip ${o.url}`,
          },
          off ? "Switch on" : "Switch off",
        );
        flip.addEventListener("click", () =>
          this.ask(off ? { type: "output", add: o.url } : { type: "output", off: o.url }),
        );
        return h(
          "li",
          { class: "row" },
          h("span", { class: `dot ${mood(o)}`.trim() }),
          h(
            "div",
            { class: "row-text" },
            h("b", { class: "url" }, o.url),
            h("span", { class: "state-words" }, [o.state, o.words].filter(Boolean).join(": ")),
            h("span", { class: "soft", "data-facts": "" }, ""),
          ),
          flip,
          remove,
        );
      }),
    );
    // Counters change all the time: only their text.
    this.list.querySelectorAll("[data-facts]").forEach((e, i) => {
      const o = outputs[i];
      if (o) e.textContent = this.connected ? facts(o) : "";
    });
  }

  private ask(c: Command): void {
    if (!this.send(c)) this.error.textContent = NOBODY;
  }

  private add(): void {
    const url = this.input.value.trim();
    if (!LOOKS_LIKE_URL.test(url)) {
      this.complain("An address looks like vmc://localhost:39539. Choose an example and change it.");
      return;
    }
    if (url.length > LONGEST_ADDRESS) {
      this.complain(`An address has up to ${LONGEST_ADDRESS} characters.`);
      return;
    }
    if (this.send({ type: "output", add: url })) {
      this.asked = { url, shown: withoutPassword(url), at: performance.now() };
      this.input.value = "";
      this.complain("");
    } else {
      this.complain(NOBODY);
    }
  }

  /** An error of the program: true when it is the answer to an address, and stands beside it now. */
  refused(words: string): boolean {
    const asked = this.asked;
    if (!asked || performance.now() - asked.at > ANSWER) return false;
    if (!words.includes(asked.shown)) return false; // of something else: a full disk
    this.asked = null;
    this.input.value ||= asked.url;
    this.complain(words);
    return true;
  }

  private complain(words: string): void {
    this.error.textContent = words;
    this.input.setAttribute("aria-invalid", String(Boolean(words)));
  }
}
