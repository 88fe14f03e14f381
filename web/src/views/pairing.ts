// SPDX-License-Identifier: Apache-2.0
// Pairs pictures with poses. A pose arrives later than the picture that it was found in, so that the newest of both do not
// belong together.

interface Numbered {
  frame: number;
}

const KEPT_PICTURES = 6;
const KEPT_POSES = 12;
export const POSES_STOPPED = 400; // ms without a pose, after which pictures are shown as they arrive

export class Pairing<Picture extends Numbered, Pose extends Numbered> {
  private pictures: Picture[] = [];
  private poses: Pose[] = [];
  private lastPose = -Infinity;

  /** `drop` frees a picture that will not be shown again. */
  constructor(private readonly drop: (p: Picture) => void) {}

  picture(p: Picture): void {
    // A smaller number: the program has been restarted.
    const last = this.pictures.at(-1);
    if (last && p.frame < last.frame) this.clear();
    this.pictures.push(p);
    while (this.pictures.length > KEPT_PICTURES) this.drop(this.pictures.shift()!);
  }

  /** `now` in ms. */
  pose(p: Pose, now: number): void {
    const last = this.poses.at(-1);
    if (last && p.frame < last.frame) this.poses = [];
    this.poses.push(p);
    if (this.poses.length > KEPT_POSES) this.poses.shift();
    this.lastPose = now;
  }

  clear(): void {
    for (const p of this.pictures) this.drop(p);
    this.pictures = [];
    this.poses = [];
    this.lastPose = -Infinity;
  }

  /** What to show at `now`: the newest picture that has a pose, or without recent poses the newest picture alone. */
  pick(now: number): { picture: Picture | null; pose: Pose | null } {
    const pose = this.poses.at(-1);
    const newest = this.pictures.at(-1) ?? null;
    if (!pose || now - this.lastPose > POSES_STOPPED) return { picture: newest, pose: null };
    const ready = this.pictures.filter((p) => p.frame <= pose.frame);
    const picture = ready.pop() ?? newest;
    for (const p of ready) this.drop(p); // older ones are not needed again
    this.pictures = this.pictures.filter((p) => !ready.includes(p));
    return { picture, pose: this.poses.find((p) => picture && p.frame === picture.frame) ?? pose };
  }
}
