// SPDX-License-Identifier: Apache-2.0
// Builds an avatar from a VRM file. It stands in the scene and faces +z.

import { VRMLoaderPlugin, VRMUtils, type VRM, type VRMHumanBoneName } from "@pixiv/three-vrm";
import {
  Box3,
  Mesh,
  MeshLambertMaterial,
  MeshStandardMaterial,
  Quaternion,
  Vector3,
  type Material,
  type Object3D,
} from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { drawsInSoftware } from "../shared/graphics";
import type { Quat, Vec3 } from "../shared/quaternion";
import { AvatarFace, FACE_AT_REST, type Face } from "./face";
import { foldMissing } from "./fold";
import { dropOddSprings, fitToHuman, scaleSprings } from "./fit";
import { AvatarError, inspect, isObject, type Facts, type Json } from "./inspect";

const ASIDE = 0.3; // m from the middle: an avatar that stands farther away is moved

export interface BoneReading {
  /** Rotation parent from bone of the normalised skeleton (T-pose, facing +z), as in a pose message. */
  local: Quat;
  /** Rotation of the file's own bone from the T-pose, in world axes (y up, the avatar faces +z). */
  world: Quat;
  /** Position of the file's own bone, m, world. */
  position: Vec3;
}

export class Avatar {
  readonly scene: Object3D;
  readonly hipHeight: number; // m
  readonly headHeight: number; // m, of the head bone
  readonly top: number; // m
  readonly hasSprings: boolean;
  /** What was changed or left out, for the user. */
  readonly notes: string[];
  readonly face: AvatarFace;
  private readonly restWorld = new Map<string, Quaternion>();
  private readonly restHips: Vector3;
  /** VRM 0.x faces -z in its own frame: the signs of x and z change. */
  private readonly flip: 1 | -1;
  /** Height of the hips in the file's own unit. */
  private readonly ownHipHeight: number;

  /** Throws AvatarError if the avatar cannot be seen or does not stand upright. */
  constructor(
    private readonly vrm: VRM,
    readonly facts: Facts,
    notes: string[] = [],
  ) {
    this.scene = vrm.scene;
    this.face = new AvatarFace(vrm);
    this.flip = facts.version === "0" ? -1 : 1;
    vrm.humanoid.resetNormalizedPose();
    vrm.update(0);
    vrm.scene.updateMatrixWorld(true);
    const box = new Box3().setFromObject(vrm.scene, true);
    if (box.isEmpty()) throw new AvatarError("This avatar cannot be seen: it has no mesh.");
    const at = (bone: VRMHumanBoneName) => this.raw(bone)!.getWorldPosition(new Vector3());
    const height = (bone: VRMHumanBoneName) => at(bone).y;
    const { x, z } = at("hips");
    const fit = fitToHuman({
      hips: height("hips"),
      head: height("head"),
      foot: Math.min(height("leftFoot"), height("rightFoot")),
      low: box.min.y,
    });
    if (!fit) throw new AvatarError("This avatar cannot be moved: its head is not above its hips.");
    this.notes = [...notes, ...fit.notes];
    const aside = fit.scale * Math.hypot(x, z) > ASIDE;
    if (aside) this.notes.push("it was moved to the middle");
    vrm.scene.scale.multiplyScalar(fit.scale);
    if (vrm.springBoneManager) scaleSprings(vrm.springBoneManager, fit.scale);
    vrm.scene.position.y += fit.lift;
    if (aside) vrm.scene.position.add(new Vector3(-fit.scale * x, 0, -fit.scale * z));
    vrm.scene.updateMatrixWorld(true);
    vrm.springBoneManager?.reset();
    for (const bone of this.boneNames) {
      const raw = this.raw(bone);
      if (raw) this.restWorld.set(bone, raw.getWorldQuaternion(new Quaternion()));
    }
    this.restHips = this.node("hips")!.position.clone();
    this.hipHeight = this.position("hips", new Vector3()).y;
    this.headHeight = this.position("head", new Vector3()).y;
    this.ownHipHeight = this.hipHeight / fit.scale;
    this.top = fit.scale * box.max.y + fit.lift;
    this.hasSprings = (vrm.springBoneManager?.joints.size ?? 0) > 0;
  }

  private node(bone: string): Object3D | null {
    return this.vrm.humanoid.getNormalizedBoneNode(bone as VRMHumanBoneName);
  }

  /** The file's own bone. */
  private raw(bone: VRMHumanBoneName): Object3D | null {
    return this.vrm.humanoid.getRawBoneNode(bone);
  }

  private get boneNames(): VRMHumanBoneName[] {
    return Object.keys(this.vrm.humanoid.humanBones) as VRMHumanBoneName[];
  }

  /** `hips`: displacement from the T-pose as a fraction of the hips' height. `dt`: time step of hair and clothes, s. */
  show(bones: ReadonlyMap<string, Quat>, hips: Vec3, dt: number, face: Face = FACE_AT_REST): void {
    this.face.show(face);
    const f = this.flip;
    for (const [bone, q] of foldMissing(bones, (b) => this.node(b) !== null)) {
      this.node(bone)!.quaternion.set(f * q[0], q[1], f * q[2], q[3]);
    }
    const s = this.ownHipHeight;
    this.node("hips")!.position.set(
      this.restHips.x + f * s * hips[0],
      this.restHips.y + s * hips[1],
      this.restHips.z + f * s * hips[2],
    );
    this.vrm.update(dt);
  }

  /** Call it after the avatar has been moved at once: hair and clothes come to rest. */
  resetSprings(): void {
    this.vrm.scene.updateMatrixWorld(true);
    this.vrm.springBoneManager?.reset();
  }

  /** Hides the head and what is attached to it, for pictures from the avatar's eyes. */
  set headless(on: boolean) {
    // The head shrinks to a point inside the neck. Poses do not change the scale.
    this.raw("head")!.scale.setScalar(on ? 1e-4 : 1);
  }

  /** Position of a bone, m, world. */
  position(bone: "head" | "hips", out: Vector3): Vector3 {
    return this.raw(bone)!.getWorldPosition(out);
  }

  read(): Record<string, BoneReading> {
    this.vrm.scene.updateMatrixWorld(true);
    const out: Record<string, BoneReading> = {};
    for (const bone of this.boneNames) {
      const rest = this.restWorld.get(bone);
      const raw = this.raw(bone);
      const n = this.node(bone);
      if (!rest || !raw || !n) continue;
      const world = raw.getWorldQuaternion(new Quaternion()).multiply(rest.clone().invert());
      const p = raw.getWorldPosition(new Vector3());
      out[bone] = {
        local: [this.flip * n.quaternion.x, n.quaternion.y, this.flip * n.quaternion.z, n.quaternion.w],
        world: [world.x, world.y, world.z, world.w],
        position: [p.x, p.y, p.z],
      };
    }
    return out;
  }

  dispose(): void {
    VRMUtils.deepDispose(this.vrm.scene);
  }
}

/** The same colours without gloss, which costs less. Toon materials stay: they define how an avatar looks. */
function cheap(material: Material | Material[]): Material | Material[] {
  if (Array.isArray(material)) return material.map((m) => cheap(m) as Material);
  if (!(material instanceof MeshStandardMaterial)) return material;
  const { color, map, emissive, emissiveMap, alphaMap, name } = material; // its textures and colours
  const { alphaTest, transparent, opacity, side, vertexColors } = material;
  const colours = { color, map, emissive, emissiveMap, alphaMap, vertexColors };
  return new MeshLambertMaterial({ ...colours, alphaTest, transparent, opacity, side, name });
}

/** Lights of an avatar would light all else in the scene. */
function dropLights(json: Json): void {
  for (const node of Array.isArray(json.nodes) ? (json.nodes as unknown[]) : []) {
    if (isObject(node) && isObject(node.extensions)) delete node.extensions.KHR_lights_punctual;
  }
}

/** Throws AvatarError when the file cannot be used. */
export async function loadAvatar(data: ArrayBuffer): Promise<Avatar> {
  const facts = inspect(data);
  const loader = new GLTFLoader();
  const notes: string[] = [];
  loader.register((parser) => {
    dropLights(parser.json as Json);
    if (dropOddSprings(parser.json as Json) > 0) {
      notes.push("broken springs of hair or clothes, or what they bounce off, were left out");
    }
    return new VRMLoaderPlugin(parser);
  });
  let vrm: VRM | undefined;
  try {
    const gltf = await loader.parseAsync(data, "");
    vrm = gltf.userData.vrm as VRM | undefined;
    if (!vrm) throw new Error("no VRM in the file");
    VRMUtils.rotateVRM0(vrm);
    VRMUtils.combineSkeletons(gltf.scene);
    vrm.scene.traverse((o) => {
      o.frustumCulled = false; // the bounds are those of the T-pose
      if (drawsInSoftware() && o instanceof Mesh) o.material = cheap(o.material);
    });
    return new Avatar(vrm, facts, notes);
  } catch (e) {
    if (vrm) VRMUtils.deepDispose(vrm.scene);
    if (e instanceof AvatarError) throw e;
    console.warn("avatar:", e);
    throw new AvatarError("The file is broken: its 3-D model could not be built.");
  }
}
