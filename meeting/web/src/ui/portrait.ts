// SPDX-License-Identifier: Apache-2.0
// Small drawn portraits of the project's looks, in their colours (apps/avatars/outfit.cpp).

import { drawing } from "#web/shared/icons";

interface Colours {
  skin: string;
  hair: string;
  top: string;
}

const LOOK: Record<string, Colours> = {
  plain: { skin: "#d9a581", hair: "#3b2a20", top: "#3e7cb1" },
  casual: { skin: "#f0c6a5", hair: "#7a3e22", top: "#e2a33a" },
  office: { skin: "#8d5a3c", hair: "#17120f", top: "#2f3b52" },
  summer: { skin: "#b97a56", hair: "#251813", top: "#d8574e" },
  robot: { skin: "#2c3138", hair: "#edf0f2", top: "#edf0f2" },
};

const HAIR: Record<string, string> = {
  plain: "M12.5 18.5C11.5 11 15 7.5 20 7.5s8.5 3.5 7.5 11c-.8-3-1.5-5-3-6-3 1-6.5 1-9 0-1.5 1-2.2 3-3 6z",
  casual:
    "M11 25C9.5 12 13 6.5 20 6.5S30.5 12 29 25c-2 1-3.5.8-4 0 1.2-4 1.2-8 .5-11-3 1-8 1-11 0-.7 3-.7 7 .5 11-.5.8-2 1-4 0z",
  office: "M12.5 18C11.5 11 15 8 20 8s8.5 3 7.5 10c-.7-3-1.3-4.5-2.5-6-3 .6-7 .6-10 0-1.2 1.5-1.8 3-2.5 6z",
  summer:
    "M12.5 18.5C11.5 11 15 8 20 8s8.5 3.5 7.5 10.5C26.5 13.5 23.5 12 20 12s-6.5 1.5-7.5 6.5zM16.5 6.5a3.5 3 0 1 1 7 0 3.5 3 0 1 1-7 0z",
};

/** Head and shoulders; "url" and "none" are outlines. */
export function portrait(look: string): SVGSVGElement {
  const c = LOOK[look];
  if (!c) {
    const none = "M14 9v13h10.5a2 2 0 0 1 2 2v3H14M14 22v10M26 27v5";
    return drawing("portrait outline", 40, `<path d="${look === "none" ? none : "M20 11v18M11 20h18"}"/>`);
  }
  const path = (d: string, fill: string): string => `<path d="${d}" fill="${fill}"/>`;
  const robot =
    path("M12 20c0-9 3-12 8-12s8 3 8 12l-2 6h-12z", c.hair) +
    `<rect x="13.5" y="15" width="13" height="5" rx="2.5" fill="${c.skin}"/>` +
    '<circle cx="17" cy="17.5" r="1.3" fill="#63e6e2"/><circle cx="23" cy="17.5" r="1.3" fill="#63e6e2"/>';
  return drawing(
    "portrait",
    40,
    path("M6 40c0-9 5.5-12.5 14-12.5S34 31 34 40z", c.top) +
      path("M17 24h6v5c-1.8 1.8-4.2 1.8-6 0z", c.skin) +
      `<ellipse cx="20" cy="18" rx="7" ry="8.5" fill="${c.skin}"/>` +
      (look === "robot" ? robot : path(HAIR[look] ?? HAIR.plain!, c.hair)),
  );
}
