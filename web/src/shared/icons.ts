// SPDX-License-Identifier: Apache-2.0
// Line icons of both pages on a 24 x 24 grid. They are SVG markup and drawn with the colour of the text.

import { h } from "./dom";

const ICONS = {
  again: '<path d="M19.5 12a7.5 7.5 0 1 1-2.4-5.5M19.5 3.5v4h-4"/>',
  board:
    '<rect x="3" y="4.5" width="18" height="12" rx="1.5"/><path d="M8 20l2-3.5M16 20l-2-3.5M7 12.5c2-4 3 1 5-1.5s3-1.5 5-.5"/>',
  bones: '<circle cx="12" cy="5" r="2"/><path d="M12 7v8M12 10l-6 3M12 10l6 3M12 15l-3 6M12 15l3 6"/>',
  chair: '<path d="M7 3.5v9h9.5a1.5 1.5 0 0 1 1.5 1.5V15H7M7 12v8.5M17.5 15v5.5"/>',
  close: '<path d="m6 6 12 12M18 6 6 18"/>',
  eye: '<path d="M2.5 12S6 5.8 12 5.8 21.5 12 21.5 12 18 18.2 12 18.2 2.5 12 2.5 12z"/><circle cx="12" cy="12" r="2.6"/>',
  help: '<circle cx="12" cy="12" r="8.5"/><path d="M9.6 9.5a2.5 2.5 0 1 1 3.6 2.3c-.8.4-1.2.9-1.2 1.7v.4M12 16.8v.1"/>',
  info: '<circle cx="12" cy="12" r="8.5"/><path d="M12 11v5.5M12 7.6v.1"/>',
  leave: '<path d="M10 4.5H5.5v15H10M14.5 8l4 4-4 4M18 12H9.5"/>',
  lock: '<rect x="5" y="11" width="14" height="9" rx="2"/><path d="M8 11V8a4 4 0 0 1 8 0v3"/>',
  mirror: '<path d="M12 3v18M9 7 3.5 17H9zM15 7l5.5 10H15z"/>',
  orbit:
    '<ellipse cx="12" cy="12" rx="9" ry="4"/><circle cx="12" cy="12" r="2"/><path d="M18.5 5.5 21 8l-3 1.4"/>',
  panel: '<rect x="3.5" y="5" width="17" height="14" rx="2.5"/><path d="M14.5 5v14"/>',
  reset: '<path d="M4 9V4h5M20 9V4h-5M4 15v5h5M20 15v5h-5"/><circle cx="12" cy="12" r="2.2"/>',
  ruler: '<path d="M4.5 16 16 4.5l3.5 3.5L8 19.5zM8 12.5l1.5 1.5M11 9.5l1.5 1.5M14 6.5 15.5 8"/>',
  trash: '<path d="M5 7h14M10 7V4.5h4V7M7 7l.8 12.5h8.4L17 7M10.3 10.5v6M13.7 10.5v6"/>',
  undo: '<path d="M8.5 5 4 9.5 8.5 14M4 9.5h10a5.5 5.5 0 0 1 0 11h-3"/>',
  upload: '<path d="M12 16V4.5M7.5 9 12 4.5 16.5 9M4.5 15.5v4h15v-4"/>',
  warning: '<path d="M12 4 2.8 19.5h18.4zM12 10v4.5M12 16.9v.1"/>',
  zoom: '<circle cx="10.5" cy="10.5" r="6"/><path d="m15 15 5.5 5.5M8 10.5h5M10.5 8v5"/>',
} as const;

export type IconName = keyof typeof ICONS;

/** A square SVG element of `size` units that screen readers skip. */
export function drawing(className: string, size: number, markup: string): SVGSVGElement {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("class", className);
  svg.setAttribute("viewBox", `0 0 ${size} ${size}`);
  svg.setAttribute("aria-hidden", "true");
  svg.innerHTML = markup;
  return svg;
}

export const icon = (name: IconName): SVGSVGElement => drawing("icon", 24, ICONS[name]);

/** A button that removes something: `label` begins with the verb. `attributes` identify it. */
export function trashButton(label: string, onclick: () => void, attributes: Record<string, string>) {
  const title = label.split(" ")[0]!;
  return h(
    "button",
    { class: "icon-button", "aria-label": label, title, onclick, ...attributes },
    icon("trash"),
  );
}
