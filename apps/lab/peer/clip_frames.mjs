// SPDX-License-Identifier: Apache-2.0
// The frames of a video file, by ffmpeg.

import { execFileSync, spawn } from "node:child_process";

/** Seconds from the first frame, of each frame in order, as the file states them. */
export function frameTimes(file) {
  const entries = ["-select_streams", "v:0", "-show_entries", "packet=pts_time", "-of", "csv=p=0"];
  const times = execFileSync("ffprobe", ["-v", "error", ...entries, file], {
    encoding: "utf8",
    maxBuffer: 1 << 28,
  })
    .split(/[\s,]+/)
    .filter((word) => word !== "" && word !== "N/A")
    .map(Number)
    .sort((a, b) => a - b); // packets are in the order of decoding
  return times.map((time) => time - times[0]);
}

/** Each frame once, as { width, height, rgba }. */
export async function* framesOf(file) {
  const form = "-map 0:v:0 -fps_mode passthrough -f image2pipe -c:v pam -pix_fmt rgba".split(" ");
  const decoder = spawn("ffmpeg", ["-v", "error", "-nostdin", "-i", file, ...form, "-"], {
    stdio: ["ignore", "pipe", "inherit"],
  });
  const ended = new Promise((resolve, reject) => {
    decoder.on("error", reject);
    decoder.on("close", resolve);
  });
  ended.catch(() => {}); // awaited at the end
  let bytes = Buffer.alloc(0);
  try {
    // If the pipe closed before ffmpeg is killed, ffmpeg would complain.
    for await (const chunk of decoder.stdout.iterator({ destroyOnReturn: false })) {
      bytes = Buffer.concat([bytes, chunk]);
      for (let frame = firstFrame(bytes); frame; frame = firstFrame(bytes)) {
        bytes = bytes.subarray(frame.end);
        yield frame;
      }
    }
    const status = await ended;
    if (status !== 0 || bytes.length > 0) throw new Error(`ffmpeg could not decode all of ${file}`);
  } finally {
    decoder.kill("SIGKILL");
    decoder.stdout.destroy();
  }
}

/** The frame (Netpbm's PAM) with which the bytes begin, once it is complete. */
function firstFrame(bytes) {
  const marker = bytes.indexOf("ENDHDR\n");
  if (marker < 0) return undefined;
  const header = bytes.toString("latin1", 0, marker);
  const [width, height] = ["WIDTH", "HEIGHT"].map((key) =>
    Number(new RegExp(`${key} (\\d+)`).exec(header)[1]),
  );
  const begin = marker + "ENDHDR\n".length;
  const end = begin + 4 * width * height;
  return bytes.length < end ? undefined : { width, height, rgba: bytes.subarray(begin, end), end };
}
