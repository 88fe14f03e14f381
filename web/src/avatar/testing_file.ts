// SPDX-License-Identifier: Apache-2.0
// For tests: small avatar files.

import { REQUIRED_BONES } from "./inspect";

/** A binary glTF file of this JSON (or text in its place) and, when given, a binary part. */
export function glbFile(json: unknown, binary?: Uint8Array): Uint8Array<ArrayBuffer> {
  const text = typeof json === "string" ? json : JSON.stringify(json);
  const head = new TextEncoder().encode(text.padEnd(4 * Math.ceil(text.length / 4)));
  const out = new Uint8Array(20 + head.length + (binary ? 8 + binary.length : 0));
  const words = (at: number, ...values: number[]): void =>
    values.forEach((v, i) => new DataView(out.buffer).setUint32(at + 4 * i, v, true));
  words(0, 0x46546c67, 2, out.length, head.length, 0x4e4f534a);
  out.set(head, 20);
  if (binary) {
    words(20 + head.length, binary.length, 0x004e4942);
    out.set(binary, 28 + head.length);
  }
  return out;
}

/** The JSON of a VRM 1.0 file with all required bones but `without`. */
export const vrm1 = (without?: string) => ({
  nodes: REQUIRED_BONES.map((name) => ({ name })),
  extensions: {
    VRMC_vrm: {
      meta: { name: "Ada", authors: ["B", "C"] },
      humanoid: {
        humanBones: Object.fromEntries(
          REQUIRED_BONES.map((bone, node) => [bone, { node }] as const).filter(([bone]) => bone !== without),
        ),
      },
    },
  },
});
