// SPDX-License-Identifier: Apache-2.0
// A network camera: serves the pictures of show() as Motion JPEG over HTTP.

import { execFileSync } from "node:child_process";
import { createServer } from "node:http";

const EOI = Buffer.from([0xff, 0xd9]);

/** The pictures of a clip as JPEGs, by ffmpeg. */
export function picturesOf(file) {
  const all = execFileSync(
    "ffmpeg",
    ["-v", "error", "-i", file, "-f", "image2pipe", "-c:v", "mjpeg", "-q:v", "2", "-"],
    { maxBuffer: 1 << 28 },
  );
  const pictures = [];
  for (let from = 0; from < all.length;) {
    const end = all.indexOf(EOI, from) + 2; // these bytes occur only at the end of a JPEG
    if (end < 2) throw new Error(`${file}: the output of ffmpeg is incomplete`);
    pictures.push(all.subarray(from, end));
    from = end;
  }
  return pictures;
}

export async function startCamera(pictures, fps) {
  const viewers = new Set();
  let showing = pictures;
  let at = 0;
  const server = createServer((request, response) => {
    response.writeHead(200, { "content-type": "multipart/x-mixed-replace; boundary=picture" });
    viewers.add(response);
    response.on("close", () => viewers.delete(response));
  });
  const timer = setInterval(() => {
    const picture = showing[at++ % showing.length];
    const head = `--picture\r\nContent-Type: image/jpeg\r\nContent-Length: ${picture.length}\r\n\r\n`;
    for (const v of viewers) v.write(Buffer.concat([Buffer.from(head), picture, Buffer.from("\r\n")]));
  }, 1000 / fps);
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return {
    url: `http://127.0.0.1:${server.address().port}/camera.mjpg`,
    show(others) {
      showing = others;
      at = 0;
    },
    close() {
      clearInterval(timer);
      server.closeAllConnections();
      server.close();
    },
  };
}
