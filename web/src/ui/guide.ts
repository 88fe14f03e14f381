// SPDX-License-Identifier: Apache-2.0
// The guided setup: step out of view, step in, done. It follows the program's phase. Its text is large enough to be read
// from where the person stands.

import type { Command, Phase, Status } from "../live/protocol";
import { button, byId } from "../shared/dom";

const COUNTDOWN = 5; // s
const DONE_SHOWN = 2200; // ms

interface Step {
  /** Distinguishes steps with the same title; the title by default. */
  key?: string;
  number: 1 | 2 | 3;
  title: string;
  text: string;
  figure: "out" | "room" | "in" | "done" | "camera";
}

const STEPS: Partial<Record<Phase | "around" | "done", Step>> = {
  opening: { number: 1, title: "Opening the camera", text: "One moment.", figure: "camera" },
  empty_room: {
    number: 1,
    title: "Step out of view",
    text: "Telemime captures the empty background first. Start the countdown and step out, or confirm that nobody is in view.",
    figure: "out",
  },
  background: {
    number: 1,
    title: "Capturing the background",
    text: "Stay out of view for a moment.",
    figure: "room",
  },
  // The background phase when the user has not confirmed that nobody is in view.
  around: {
    key: "Capturing the background around you",
    number: 1,
    title: "Capturing the background",
    text: "Stay where you are for a moment. The background is learned around you.",
    figure: "in",
  },
  person: {
    number: 2,
    title: "Step in and face the camera",
    text: "Stand still with your arms slightly away from your body.",
    figure: "in",
  },
  done: { number: 3, title: "Done", text: "The avatar follows you.", figure: "done" },
};

export class Guide {
  private readonly box = byId("guide", HTMLElement);
  private readonly countdown = byId("countdown", HTMLElement);
  private readonly countButton: HTMLButtonElement;
  private phase: Phase | null = null;
  private roomEmpty = false;
  private guided = false;
  private doneUntil = 0;
  private left = 0;
  private timer = 0;

  constructor(
    private readonly send: (c: Command) => boolean,
    private readonly announce: (words: string) => void,
    private readonly layout: (guiding: boolean) => void,
  ) {
    this.countButton = button("guide-count", () => this.toggleCountdown());
    button("guide-now", () => this.empty());
    button("guide-skip", () => this.skip());
    button("guide-back", () => this.again());
  }

  setStatus(s: Status): void {
    const before = this.phase;
    this.phase = s.phase;
    this.roomEmpty = s.roomEmpty;
    if (s.phase !== "empty_room") this.stopCountdown();
    if (s.phase === "person" || s.phase === "background" || s.phase === "empty_room") this.guided = true;
    if (s.phase === "tracking" && this.guided && before !== null) {
      this.guided = false;
      this.doneUntil = performance.now() + DONE_SHOWN;
      window.setTimeout(() => this.show(""), DONE_SHOWN + 20);
    }
    this.show(s.words);
  }

  /** The phase is unknown until the next status. */
  disconnected(): void {
    this.stopCountdown();
    this.phase = null;
    this.guided = false;
    this.show("");
  }

  /** Starts or stops the countdown, in the phase that waits for an empty scene. */
  toggleCountdown(): void {
    if (this.phase !== "empty_room") return;
    if (this.left > 0) {
      this.stopCountdown();
      this.announce("Countdown stopped.");
      return;
    }
    this.left = COUNTDOWN;
    this.tick();
    this.timer = window.setInterval(() => {
      this.left--;
      if (this.left > 0) this.tick();
      else this.empty();
    }, 1000);
  }

  skip(): void {
    if (this.phase === "empty_room") this.answer("skip");
    this.stopCountdown();
  }

  again(): void {
    this.answer("again");
  }

  private empty(): void {
    this.stopCountdown();
    if (this.phase === "empty_room") this.answer("empty");
  }

  private answer(step: "empty" | "skip" | "again"): void {
    if (!this.send({ type: "guide", step })) this.announce("There is no connection to Telemime.");
  }

  private tick(): void {
    this.countdown.hidden = false;
    this.countdown.textContent = String(this.left);
    this.countButton.textContent = "Stop the countdown";
    this.announce(String(this.left));
  }

  private stopCountdown(): void {
    window.clearInterval(this.timer);
    this.left = 0;
    this.countdown.hidden = true;
    this.countButton.textContent = `Start the ${COUNTDOWN}-second countdown`;
  }

  private show(words: string): void {
    const done = performance.now() < this.doneUntil && this.phase === "tracking";
    const around = this.phase === "background" && !this.roomEmpty;
    const step = STEPS[done ? "done" : around ? "around" : (this.phase ?? "stopped")];
    const key = step ? (step.key ?? step.title) : "";
    byId("guide-words", HTMLElement).textContent = words && words !== step?.title ? words : "";
    if (this.box.dataset.step === key) return;
    const focus = this.box.contains(document.activeElement) ? document.activeElement : null;
    this.box.dataset.step = key;
    this.box.hidden = !step;
    this.layout(Boolean(step));
    if (step) this.fill(step, done);
    // A hidden button cannot keep the focus.
    if (focus?.getClientRects().length === 0) byId(step ? "guide-title" : "main", HTMLElement).focus();
  }

  private fill(step: Step, done: boolean): void {
    byId("guide-title", HTMLElement).textContent = step.title;
    byId("guide-text", HTMLElement).textContent = step.text;
    this.box.dataset.figure = step.figure;
    document.querySelectorAll<HTMLElement>("#guide-steps li").forEach((li, i) => {
      const n = i + 1;
      li.dataset.state =
        n < step.number || (done && n === step.number) ? "past" : n === step.number ? "now" : "next";
      if (n === step.number) li.setAttribute("aria-current", "step");
      else li.removeAttribute("aria-current");
    });
    byId("guide-actions", HTMLElement).dataset.phase = this.phase ?? "";
    this.announce(`${step.title}. ${step.text}`);
  }
}
