// SPDX-License-Identifier: Apache-2.0
// The frame that both pages share: header, banner, side panel, messages and help dialog.

import { byId, h } from "./dom";
import { drawing, icon, type IconName } from "./icons";

const MARK = '<circle cx="16" cy="7.5" r="4"/><path d="M16 14v9M16 16 7 13.5 4.5 6.5M16 16l9 4 2.5 7"/>';

const button = (id: string, icon: IconName, title: string, attributes: Record<string, string> = {}) =>
  h("button", { id, "data-icon": icon, title, ...attributes });

/** The product mark, the title, and what the page marks with data-brand. */
function brand(): HTMLElement {
  const mark = drawing("mark", 32, MARK);
  const more = document.querySelectorAll("[data-brand]");
  return h("div", { class: "brand" }, mark, h("h1", { id: "title" }, "Telemime"), ...more);
}

/** The side panel: one tab for each element of the class tab-page, which names it by data-tab and data-label. */
function panel(): HTMLElement {
  const pages = [...document.querySelectorAll<HTMLElement>(".tab-page")];
  const tabs = pages.map((page) => {
    const name = page.dataset.tab!;
    page.id = `page-${name}`;
    page.setAttribute("role", "tabpanel");
    page.setAttribute("aria-labelledby", `tab-${name}`);
    page.tabIndex = 0;
    return h(
      "button",
      { role: "tab", id: `tab-${name}`, "data-tab": name, "aria-controls": page.id },
      `${page.dataset.label} `,
      h("span", { id: `count-${name}`, class: "count" }),
    );
  });
  const close = button("panel-close", "close", "Close the side panel");
  return h(
    "aside",
    { id: "panel", class: "panel", "aria-label": "Side panel" },
    h("div", { class: "tabs" }, h("div", { role: "tablist", "aria-label": "Side panel" }, ...tabs), close),
    ...pages,
  );
}

function helpDialog(note: string): HTMLElement {
  return h(
    "dialog",
    { id: "help-dialog", "aria-labelledby": "help-title" },
    h(
      "header",
      {},
      h("h2", { id: "help-title" }, "Keyboard shortcuts"),
      button("help-close", "close", "Close"),
    ),
    h("dl", { id: "help-list" }),
    h(
      "label",
      { class: "check" },
      h("input", { type: "checkbox", id: "help-keys" }),
      "Use single-key shortcuts",
    ),
    h("p", { class: "soft" }, note),
  );
}

/** Draws the icon that an element names by data-icon. Buttons without text are icon buttons, labelled by their title. */
function drawIcons(): void {
  for (const e of document.querySelectorAll<HTMLElement>("[data-icon]")) {
    if (!e.textContent?.trim()) {
      e.classList.add("icon-button");
      if (e.title) e.setAttribute("aria-label", e.title.replace(/ \([^)]*\)$/, ""));
    }
    e.prepend(icon(e.dataset.icon as IconName));
  }
}

/**
 * Builds the frame around the page's #main, with the page's #actions in the header. `state`: the first text of the state
 * line; `note`: the last paragraph of the help dialog. Call it once, before anything looks for elements.
 */
export function buildFrame({ state, note }: { state: string; note: string }): void {
  const actions = byId("actions", HTMLElement);
  actions.append(
    button("panel-toggle", "panel", "Side panel (p)", {
      "aria-expanded": "false",
      "aria-controls": "panel",
    }),
    button("help", "help", "Help and shortcuts (?)"),
  );
  const stateLine = h(
    "div",
    { class: "state", id: "state" },
    h("span", { id: "state-dot", class: "dot" }),
    h("b", { id: "state-name" }, state),
    h("span", { id: "state-words" }),
  );
  document.body.prepend(
    h("a", { class: "skip", href: "#main" }, "Skip to the main content"),
    h("header", { class: "bar" }, brand(), stateLine, actions),
    h(
      "div",
      { id: "banner", class: "banner", role: "alert", hidden: "" },
      h("p", { id: "banner-words" }),
      h("button", { id: "banner-try", class: "quiet" }, "Try now"),
    ),
    h("div", { class: "page" }, byId("main", HTMLElement), panel()),
  );
  document.body.append(
    h("div", { id: "toasts", class: "toasts", role: "log", "aria-live": "polite", "aria-label": "Messages" }),
    h("div", { id: "live", class: "hidden-text", role: "status", "aria-live": "polite" }),
    helpDialog(note),
  );
  drawIcons();
  document.body.dataset.frame = "ready"; // base.css hides the page until then
}
