// SPDX-License-Identifier: Apache-2.0
// The chat, as text.

import { byId, h, setCount, setText } from "#web/shared/dom";
import { MOST_LINES, type Line } from "../chat";

/** 0 to 5, the same for the same participant. */
export function hueOf(id: string): number {
  let n = 0;
  for (const c of id) n = (n * 31 + c.codePointAt(0)!) % 9973;
  return n % 6;
}

export class ChatView {
  private readonly lines = byId("lines", HTMLElement);
  private readonly text = byId("chat-text", HTMLInputElement);
  private readonly error = byId("chat-error", HTMLElement);
  private unread = 0;
  private open = false;

  /**
   * `send` gives an empty string, or the reason why the message cannot be sent. `announce` tells screen readers what is
   * added while the chat is not visible; they read a visible chat by themselves.
   */
  constructor(
    private readonly send: (text: string) => string,
    private readonly announce: (words: string) => void,
  ) {
    byId("chat-form", HTMLFormElement).addEventListener("submit", (e) => {
      e.preventDefault();
      if (!this.text.value.trim()) return;
      const refused = this.send(this.text.value);
      this.error.textContent = refused;
      if (!refused) this.text.value = "";
    });
  }

  enable(on: boolean): void {
    this.text.disabled = !on;
    this.text.placeholder = on ? "Message" : "Join with a name to write";
    this.text.form!.querySelector("button")!.disabled = !on;
  }

  /** Shows the number of messages that wait for the connection. */
  waiting(n: number): void {
    const words =
      n === 0 ? "" : `${n === 1 ? "One message waits" : `${n} messages wait`} for the connection.`;
    if (n || this.error.textContent?.endsWith("connection.")) setText(this.error, words);
  }

  clear(): void {
    this.lines.replaceChildren();
    this.setUnread(0);
  }

  add(line: Line): void {
    const box = this.lines;
    const low = box.scrollTop + box.clientHeight >= box.scrollHeight - 40;
    box.append(
      line.kind === "note"
        ? h("p", { class: "note-line soft", dir: "auto" }, line.text)
        : h(
            "p",
            { class: `line${line.mine ? " mine" : ""}`, dir: "auto" },
            h("b", { class: `hue${hueOf(line.from)}` }, h("bdi", {}, line.name)),
            h("span", { class: "said" }, line.text),
          ),
    );
    while (box.children.length > MOST_LINES) box.firstElementChild?.remove();
    if (low) box.scrollTop = box.scrollHeight;
    if (this.open) return;
    if (line.kind === "note") {
      this.announce(line.text);
    } else if (!line.mine) {
      this.announce(`${line.name}: ${line.text}`);
      this.setUnread(this.unread + 1);
    }
  }

  /** `open`: whether the chat is visible. */
  seen(open: boolean): void {
    if (this.open === open) return;
    this.open = open;
    if (!open) return;
    this.setUnread(0);
    this.lines.scrollTop = this.lines.scrollHeight;
  }

  focus(): void {
    this.text.focus();
  }

  private setUnread(n: number): void {
    this.unread = n;
    setCount("chat", Math.min(n, 99));
  }
}
