// SPDX-License-Identifier: Apache-2.0
import { defineConfig } from "vitest/config";

// The program serves dist/ at "/". A further page gets its own line in `input`.
export default defineConfig({
  build: {
    target: "es2022",
    outDir: "dist",
    assetsInlineLimit: 0, // the content security policy has no data: URLs for scripts and styles
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 1200,
    rollupOptions: { input: { live: "index.html", room: "room.html" } },
  },
  worker: { format: "es" },
  server: {
    port: 7071,
    proxy: {
      "/ws": { target: "ws://127.0.0.1:7070", ws: true },
      "/avatars": "http://127.0.0.1:7070",
      "/recordings": "http://127.0.0.1:7070",
      "/room/enter": "http://127.0.0.1:7080",
    },
  },
  test: { include: ["src/**/*.test.ts"], environment: "node", testTimeout: 20000 }, // on busy machines, too
});
