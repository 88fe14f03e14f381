// SPDX-License-Identifier: Apache-2.0
// The light of the room as a formula, for where there is no graphics card. The same lights as hall.ts has.

import { formulaOf, type Light } from "../../avatar/light";
import type { Palette } from "./palette";

export { shine, type Light } from "../../avatar/light";

export const SUN = [1.6, 3.4, 2.6] as const;
export const FILL = [-2.4, 1.8, -2.2] as const;
export const FILL_POWER = 0.45;

export function lightOf(p: Palette): Light {
  return formulaOf(
    { sky: p.sky, ground: p.ground, power: p.skyPower },
    { colour: p.sun, power: p.sunPower, from: SUN },
    { colour: p.sky, power: FILL_POWER, from: FILL },
  );
}
