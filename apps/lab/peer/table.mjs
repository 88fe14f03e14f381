// SPDX-License-Identifier: Apache-2.0
// The tables of peer.sh, in Markdown:
//   node table.mjs errors FOLDER...   one row for each clip, from telemime_accuracy.json and peer_accuracy.json in its folder
//   node table.mjs times ROUND...     the folders of the rounds: peer.json, and the runs threads_1, threads_0, whole of Telemime

import { readFileSync, realpathSync } from "node:fs";
import { basename, join } from "node:path";
import { fileURLToPath } from "node:url";

const read = (...path) => readFileSync(join(...path), "utf8");
const row = (cells) => `| ${cells.join(" | ")} |`;
const table = (head, rows) => [head, head.map(() => "---"), ...rows].map(row).join("\n");

/** The value in the middle; of an even number the mean of two. */
function median(values) {
  const sorted = [...values].sort((a, b) => a - b);
  const half = Math.floor(sorted.length / 2);
  return sorted.length % 2 === 1 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
}
const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;

const MEASURES = ["aligned_mm", "similarity_mm", "image_px"];
const DIGITS = [0, 0, 1];

/** What the table says of one evaluation. */
const summary = ({ error, frames, lost }) => ({
  errors: MEASURES.map((measure) => error.tracked[measure]),
  found: Math.round(frames.scored * (1 - lost.scored_frames)),
  scored: frames.scored,
});
const cells = ({ errors, found, scored }) => [
  ...errors.map((error, m) => error?.toFixed(DIGITS[m]) ?? "-"),
  `${found} of ${scored}`,
];

/** The mean over clips, in which each clip counts the same; without those in which nobody was found. */
function overall(summaries) {
  const some = summaries.filter(({ found }) => found > 0);
  const sum = (key) => summaries.reduce((total, clip) => total + clip[key], 0);
  return {
    errors: MEASURES.map((_, m) => (some.length > 0 ? mean(some.map(({ errors }) => errors[m])) : null)),
    found: sum("found"),
    scored: sum("scored"),
  };
}

/** `clips`: [name, Telemime's evaluation, the peer's]; evaluations as `telemime evaluate --json` writes them. */
export function errorTable(clips) {
  const rest = ["fit", "2-D, px", "found"];
  const rows = clips.map(([name, ...trackers]) => [name, ...trackers.map(summary)]);
  if (rows.length > 1) rows.push(["mean", ...[1, 2].map((tracker) => overall(rows.map((r) => r[tracker])))]);
  return table(
    ["clip", "Telemime: 3-D, mm", ...rest, "peer: 3-D, mm", ...rest],
    rows.map(([name, ...trackers]) => [name, ...trackers.flatMap(cells)]),
  );
}

/** Median time of these stages of a frame in a pose.jsonl, ms: image features and search, which follow each other. */
export function telemimeTime(text, stages = ["features", "search"]) {
  const frames = text.trim().split("\n").slice(1).map(JSON.parse);
  return median(frames.map(({ ms }) => stages.reduce((sum, stage) => sum + (ms[stage] ?? 0), 0)));
}

/** The same of the peer. */
export const peerTime = ({ frames }) => median(frames.map(({ ms }) => ms));

/** `rounds`: { peer, one, all, networks, whole }: ms a frame of the peer, of Telemime on one thread and on all, of the
 * networks, which are a part of both, and of Telemime on all threads with hands and face. */
export function timeTable(rounds) {
  const names = {
    peer: "peer",
    one: "Telemime, one thread",
    all: "Telemime, default threads",
    networks: "its networks",
    whole: "with hands and face",
  };
  return table(
    ["tracker", "ms a frame", "times the peer", "each round"],
    Object.entries(names).map(([key, name]) => {
      const ratios = rounds.map((round) => round[key] / round.peer);
      const ms = median(rounds.map((round) => round[key]));
      return [name, ms.toFixed(0), median(ratios).toFixed(2), ratios.map((r) => r.toFixed(2)).join(", ")];
    }),
  );
}

if (realpathSync(process.argv[1]) === fileURLToPath(import.meta.url)) {
  const [which, ...folders] = process.argv.slice(2);
  const evaluation = (folder, tracker) => JSON.parse(read(folder, `${tracker}_accuracy.json`));
  const tables = {
    errors: () =>
      errorTable(folders.map((f) => [basename(f), evaluation(f, "telemime"), evaluation(f, "peer")])),
    times: () =>
      timeTable(
        folders.map((folder) => ({
          peer: peerTime(JSON.parse(read(folder, "peer.json"))),
          one: telemimeTime(read(folder, "threads_1", "pose.jsonl")),
          all: telemimeTime(read(folder, "threads_0", "pose.jsonl")),
          networks: telemimeTime(read(folder, "threads_1", "pose.jsonl"), ["networks"]),
          whole: telemimeTime(read(folder, "whole", "pose.jsonl")),
        })),
      ),
  };
  console.log(tables[which]());
}
