// SPDX-License-Identifier: Apache-2.0
// window.telemime: what the page shows at this moment, for tests. Reading it changes nothing.

import type { BoneReading } from "../avatar/load";
import type { AvatarInfo } from "../ui/avatars";
import type { Pose } from "./protocol";

export interface Debug {
  /** The program's phase, or "connecting", "disconnected". */
  readonly phase: string;
  /** The last pose message; maps as plain objects. */
  readonly lastPose: Record<string, unknown> | null;
  readonly avatar: AvatarInfo | null;
  /**
   * poses, lost, pictures: messages received; misunderstood: refused ones; decoded, broken: pictures; ticks: animation
   * frames; renders: drawn pictures of the avatar; ratio: its pixel ratio; drawnSent; shown: frame number of the pose that
   * was drawn last; rest, as drawn: 0 follows the person, 1 rests.
   */
  readonly counters: Record<string, number>;
  /**
   * The avatar's bones as drawn last, by their VRM 1.0 names: `local` as in the pose message (mirrored when the avatar is),
   * `world` and `position` from the file's own bones.
   */
  boneRotations(): Record<string, BoneReading>;
  /** The weights of the avatar's expressions as drawn last, by the names of ARKit and VRM 1.0. */
  expressions(): Record<string, number>;
}

/** A pose with its maps as plain objects. */
export function plain(pose: Pose | null): Record<string, unknown> | null {
  if (!pose) return null;
  return Object.fromEntries(
    Object.entries(pose).map(([k, value]: [string, unknown]) => [
      k,
      value instanceof Map ? Object.fromEntries(value as Map<string, unknown>) : value,
    ]),
  );
}

/** `from` has getters, so that each reading is up to date. */
export function exposeDebug(from: Debug): void {
  Object.defineProperty(window, "telemime", { value: Object.freeze(from) });
}
