// SPDX-License-Identifier: Apache-2.0
import { fileURLToPath } from "node:url";
import { defineConfig } from "vitest/config";

// TELEMIME_MEETING=OFF builds the live page alone.
const meeting = process.env.TELEMIME_MEETING !== "OFF";
const root = fileURLToPath(new URL("..", import.meta.url));
/** A program refuses a Host and an Origin that are not its own. */
const behind = (target: string) => ({ target, changeOrigin: true, rewriteWsOrigin: true });
const program = behind("http://127.0.0.1:7070");

export default defineConfig({
  root,
  publicDir: "web/public",
  plugins: [
    {
      name: "pages-at-the-top", // the program serves web/dist at "/": index.html, avatar.html, meeting.html
      enforce: "post",
      generateBundle(_, bundle) {
        for (const file of Object.values(bundle)) {
          if (file.fileName.endsWith(".html")) file.fileName = file.fileName.replace(/.*\//, "");
        }
      },
    },
  ],
  build: {
    target: "es2022",
    outDir: "web/dist",
    emptyOutDir: true,
    assetsInlineLimit: 0, // the content security policy forbids data: URLs for scripts and styles
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 1200,
    rollupOptions: {
      input: {
        live: "web/index.html",
        avatar: "web/avatar.html",
        ...(meeting ? { meeting: "meeting/web/meeting.html" } : {}),
      },
    },
  },
  worker: { format: "es" },
  server: {
    port: 7071,
    watch: { ignored: ["**/build/**"] },
    proxy: {
      "/ws": { ...program, ws: true },
      "/avatars": program,
      "/recordings": program,
      "/room/enter": behind("http://127.0.0.1:7080"),
    },
  },
  test: {
    include: ["web/src/**/*.test.ts", "meeting/web/src/**/*.test.ts"],
    environment: "node",
    testTimeout: 20000, // enough on a busy computer
  },
});
