// SPDX-License-Identifier: Apache-2.0
// window.telemimeMeeting: what the meeting's page shows at this moment, for tests. Reading it changes nothing.

import type { BoneReading } from "#web/avatar/load";
import type { Quat } from "#web/shared/quaternion";
import type { LinkState } from "./link";
import type { Reading } from "./stream";

export interface DebugPerson {
  id: string;
  name: string;
  seat: number;
  kind: "tracker" | "browser" | null;
  /** The avatar is loaded. */
  dressed: boolean;
  complaint: string;
  refused: number;
  reading: Reading;
}

/** The pose that was drawn last. */
export interface DebugPose {
  session: number;
  /** The moment of the publisher's clock that is shown, microseconds. */
  captured: number;
  /** 0 follows the motion, 1 rests. */
  rest: number;
  /** Normalised rotations of the avatar's bones. */
  bones: Record<string, Quat>;
  /** Weights of the avatar's expressions, by the names of ARKit and VRM 1.0. */
  face: Record<string, number>;
}

export interface MeetingDebug {
  /** "entry", or the state of the connection. */
  readonly phase: "entry" | LinkState["kind"];
  /** The retained messages have arrived. */
  readonly settled: boolean;
  readonly me: string | null;
  /** The participants who are here, sorted by id. */
  readonly participants: DebugPerson[];
  /** The poses of all with an avatar and motion. */
  readonly poses: Record<string, DebugPose>;
  /** All visible strokes. */
  readonly strokes: { c: string; w: number; p: readonly number[] }[];
  readonly counters: Record<string, number>;
  boneRotations(id: string): Record<string, BoneReading>;
}

export function exposeMeeting(from: MeetingDebug): void {
  Object.defineProperty(window, "telemimeMeeting", { value: Object.freeze(from) });
}
