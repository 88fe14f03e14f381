// SPDX-License-Identifier: Apache-2.0
// window.telemimeMeeting: what the meeting's page shows at this moment, to be read by tests. It changes nothing.

import type { BoneReading } from "#web/avatar/load";
import type { Quat } from "#web/shared/quaternion";
import type { LinkState } from "./link";
import type { Reading } from "./quality";

export interface DebugPerson {
  id: string;
  name: string;
  seat: number;
  kind: "tracker" | "browser" | null;
  /** The avatar is there. */
  dressed: boolean;
  complaint: string;
  refused: number;
  reading: Reading;
}

/** Of what was drawn last. */
export interface DebugPose {
  session: number;
  /** The moment of the publisher's clock that is shown, microseconds. */
  captured: number;
  /** 0 follows the motion, 1 rests. */
  rest: number;
  /** Normalised rotations of the avatar's bones. */
  bones: Record<string, Quat>;
}

export interface MeetingDebug {
  /** "entry", or that of the connection: connecting, open, lost, refused, closed. */
  readonly phase: "entry" | LinkState["kind"];
  /** The broker has told what it keeps. */
  readonly settled: boolean;
  readonly me: string | null;
  /** Who is here, by id. */
  readonly participants: DebugPerson[];
  /** Of everybody with an avatar and motion. */
  readonly poses: Record<string, DebugPose>;
  /** All strokes to be seen. */
  readonly strokes: { c: string; w: number; p: readonly number[] }[];
  readonly counters: Record<string, number>;
  boneRotations(id: string): Record<string, BoneReading>;
}

declare global {
  interface Window {
    telemimeMeeting?: MeetingDebug;
  }
}

export function exposeMeeting(from: MeetingDebug): void {
  Object.defineProperty(window, "telemimeMeeting", { value: Object.freeze(from) });
}
