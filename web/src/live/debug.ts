// SPDX-License-Identifier: Apache-2.0
// window.telemime: what the page shows at this moment, to be read by tests. It changes nothing.

import type { BoneReading } from "../avatar/load";
import type { Pose } from "../protocol";
import type { AvatarInfo } from "../ui/avatars";

export interface Debug {
  /** The program's phase, or "connecting", "disconnected". */
  readonly phase: string;
  /** The last pose message; maps as plain objects. */
  readonly lastPose: Record<string, unknown> | null;
  readonly avatar: AvatarInfo | null;
  /**
   * poses, lost, pictures: messages received; misunderstood: refused ones; decoded, broken: pictures; ticks: animation
   * frames; renders: drawn pictures of the avatar; ratio: its pixel ratio; drawnSent; shown: frame number of the pose that
   * was drawn last; rest: 0 follows the person, 1 rests.
   */
  readonly counters: Record<string, number>;
  /**
   * The avatar's bones as they stand now (what was drawn last), by their VRM 1.0 names: `local` as in the pose message
   * (of a mirrored avatar: mirrored), `world` and `position` from the file's own bones.
   */
  boneRotations(): Record<string, BoneReading>;
}

declare global {
  interface Window {
    telemime?: Debug;
  }
}

function plain(pose: Pose | null): Record<string, unknown> | null {
  if (!pose) return null;
  return Object.fromEntries(
    Object.entries(pose).map(([k, v]) => [
      k,
      v instanceof Map ? Object.fromEntries(v as Map<string, unknown>) : v,
    ]),
  );
}

export function exposeDebug(from: {
  phase: () => string;
  lastPose: () => Pose | null;
  avatar: () => AvatarInfo | null;
  read: () => Record<string, BoneReading>;
  counters: () => Record<string, number>;
}): void {
  const surface: Debug = Object.freeze({
    get phase() {
      return from.phase();
    },
    get lastPose() {
      return plain(from.lastPose());
    },
    get avatar() {
      const a = from.avatar();
      return a && { ...a };
    },
    get counters() {
      return from.counters();
    },
    boneRotations: from.read,
  });
  Object.defineProperty(window, "telemime", { value: surface });
}
