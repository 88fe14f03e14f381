// SPDX-License-Identifier: Apache-2.0
// Checks a file before the 3-D library gets it: whether it is an avatar that can be driven, and if not, why.

const MAX_BYTES = 200e6;

/** The bones that VRM 1.0 requires; VRM 0.x files have them too. */
export const REQUIRED_BONES = [
  "hips",
  "spine",
  "head",
  "leftUpperArm",
  "leftLowerArm",
  "leftHand",
  "rightUpperArm",
  "rightLowerArm",
  "rightHand",
  "leftUpperLeg",
  "leftLowerLeg",
  "leftFoot",
  "rightUpperLeg",
  "rightLowerLeg",
  "rightFoot",
] as const;

export interface Facts {
  version: "0" | "1";
  author: string;
}

/** Why a file cannot be used as an avatar; the page shows `message`. */
export class AvatarError extends Error {}

export type Json = Record<string, unknown>;
export const isObject = (v: unknown): v is Json => typeof v === "object" && v !== null && !Array.isArray(v);
const text = (v: unknown): string => (typeof v === "string" ? v.trim().slice(0, 80) : "");

export function checkSize(bytes: number): void {
  if (bytes > MAX_BYTES) {
    const mb = Math.ceil(bytes / 1e6);
    throw new AvatarError(`This file is ${mb} MB. An avatar may be up to 200 MB.`);
  }
}

/** A bone name as text: "left upper arm". */
export function boneWords(bone: string): string {
  return bone.replace(/[A-Z]/g, (c) => " " + c.toLowerCase());
}

/** The JSON of a binary glTF file; throws AvatarError. */
export function readJson(data: ArrayBuffer): Json {
  const broken = "The file is broken or incomplete. Export or download it again.";
  if (data.byteLength < 20) throw new AvatarError("This is not a VRM avatar: the file is too short.");
  const view = new DataView(data);
  if (view.getUint32(0, true) !== 0x46546c67) {
    throw new AvatarError("This is not a VRM avatar. Choose a file that ends in .vrm.");
  }
  if (view.getUint32(4, true) !== 2)
    throw new AvatarError("This file uses an old version of glTF that is not supported.");
  const length = view.getUint32(12, true);
  if (view.getUint32(8, true) > data.byteLength || 20 + length > data.byteLength)
    throw new AvatarError(broken);
  if (view.getUint32(16, true) !== 0x4e4f534a) throw new AvatarError(broken);
  try {
    const json: unknown = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 20, length)));
    if (isObject(json)) return json;
  } catch {
    // Reported below.
  }
  throw new AvatarError(broken);
}

function refuseOutsideFiles(json: Json): void {
  for (const key of ["buffers", "images"]) {
    const items = json[key];
    if (!Array.isArray(items)) continue;
    for (const item of items) {
      if (isObject(item) && typeof item.uri === "string" && !item.uri.startsWith("data:")) {
        throw new AvatarError("This avatar refers to other files. Export it as a single .vrm file.");
      }
    }
  }
}

/**
 * Extensions that the 3-D library needs a decoder for. The page has none: decoders are WebAssembly, which its content
 * security policy forbids. Other extensions only cause warnings. Draco fails even where it is not required.
 */
const DRACO = "KHR_draco_mesh_compression";
const COMPRESSIONS = [DRACO, "EXT_meshopt_compression", "KHR_meshopt_compression", "KHR_texture_basisu"];

function refuseCompression(json: Json): void {
  const names = (list: string): unknown[] => (Array.isArray(json[list]) ? json[list] : []);
  const needed = [...names("extensionsRequired"), ...names("extensionsUsed").filter((n) => n === DRACO)];
  const found = COMPRESSIONS.filter((name) => needed.includes(name));
  if (found.length === 0) return;
  throw new AvatarError(
    `This file uses a compression that the page cannot read (${found.join(", ")}). Export it without compression.`,
  );
}

function bonesOf(json: Json, version: "0" | "1"): Set<string> {
  const extensions = json.extensions as Json;
  const part = extensions[version === "1" ? "VRMC_vrm" : "VRM"];
  const humanoid = isObject(part) && isObject(part.humanoid) ? part.humanoid : {};
  const count = Array.isArray(json.nodes) ? json.nodes.length : 0;
  const found = new Set<string>();
  const add = (bone: unknown, entry: unknown) => {
    const node = isObject(entry) ? entry.node : undefined;
    const exists = Number.isInteger(node) && (node as number) >= 0 && (node as number) < count;
    if (typeof bone === "string" && exists) found.add(bone);
  };
  const bones = humanoid.humanBones;
  if (version === "1" && isObject(bones)) for (const [bone, entry] of Object.entries(bones)) add(bone, entry);
  if (version === "0" && Array.isArray(bones))
    for (const entry of bones) add(isObject(entry) && entry.bone, entry);
  return found;
}

/** Version and author of the avatar; throws AvatarError when it cannot be driven. */
export function inspect(data: ArrayBuffer): Facts {
  checkSize(data.byteLength);
  const json = readJson(data);
  const extensions = isObject(json.extensions) ? json.extensions : {};
  const version = isObject(extensions.VRMC_vrm) ? "1" : isObject(extensions.VRM) ? "0" : null;
  if (!version)
    throw new AvatarError("This is a 3-D model, but not a VRM avatar: its bones are not assigned.");
  refuseOutsideFiles(json);
  refuseCompression(json);
  const bones = bonesOf(json, version);
  const missing = REQUIRED_BONES.filter((b) => !bones.has(b)).map(boneWords);
  if (missing.length > 0) {
    const some =
      missing.slice(0, 3).join(", ") + (missing.length > 3 ? ` and ${missing.length - 3} more` : "");
    throw new AvatarError(
      `This avatar cannot be moved: it lacks ${missing.length > 1 ? "the bones" : "the bone"} ${some}.`,
    );
  }
  const { meta: given } = extensions[version === "1" ? "VRMC_vrm" : "VRM"] as Json;
  const meta = isObject(given) ? given : {};
  const authors = Array.isArray(meta.authors) ? meta.authors.map(text).filter(Boolean).join(", ") : "";
  return {
    version,
    author: version === "1" ? authors : text(meta.author),
  };
}
