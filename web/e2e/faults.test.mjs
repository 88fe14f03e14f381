// SPDX-License-Identifier: Apache-2.0
// Faults: tabs that close or stall, clients that never read, a program that dies.

import assert from "node:assert/strict";
import { once } from "node:events";
import { readFileSync } from "node:fs";
import { connect } from "node:net";
import { test } from "node:test";
import { setTimeout as pause } from "node:timers/promises";
import { WebSocket } from "ws";
import { Listener } from "./listener.mjs";
import { LIGHT, LONG, follows, hasAvatar, openPage, renderers, setUp, startProgram } from "./program.mjs";

let program, browser, flat, listener;
const all = setUp(
  async (t) => {
    ({ program, browser, flat, listener } = t);
    await listener.inPhase("tracking");
  },
  { flat: true }, // pages of a browser without 3-D cost less
);

const memory = () =>
  Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${program.pid}/status`, "utf8"))[1]) / 1024; // MB

test("a page is closed and opened again", LONG, async () => {
  const first = await openPage(browser, program);
  await follows(first.page);
  await first.close();
  await listener.tracked(5);
  const second = await openPage(browser, program);
  await follows(second.page);
  assert.deepEqual(second.complaints, []);
  await second.close();
});

test("a suspended tab blocks nobody", LONG, async () => {
  const others = await renderers(browser);
  const { page, complaints, close } = await openPage(browser, program);
  await follows(page);
  const mine = (await renderers(browser)).filter((id) => !others.includes(id));
  assert.ok(mine.length > 0, "the page has a process of its own");
  const before = await page.evaluate(() => window.telemime.counters.poses);
  for (const id of mine) process.kill(id, "SIGSTOP");
  try {
    await listener.tracked(75);
  } finally {
    for (const id of mine) process.kill(id, "SIGCONT");
  }
  await follows(page);
  const newest = Math.max(...listener.poses.keys());
  await page.waitForFunction((n) => window.telemime.counters.shown >= n, newest);
  assert.ok((await page.evaluate(() => window.telemime.counters.poses)) > before);
  assert.deepEqual(complaints, []);
  await close();
});

test("clients that never read block nobody", LONG, async () => {
  await listener.tracked(25);
  const before = memory();
  const idle = await Promise.all(
    Array.from({ length: 8 }, async () => {
      const socket = connect(program.port, "127.0.0.1");
      socket.write(
        `GET /ws HTTP/1.1\r\nHost: localhost:${program.port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n` +
          "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n",
      );
      const answer = await new Promise((resolve, reject) => {
        socket.once("data", resolve);
        socket.once("error", reject);
      });
      assert.match(answer.toString("latin1"), /^HTTP\/1.1 101 /);
      socket.pause();
      return socket;
    }),
  );
  const { page, close } = await openPage(flat, program);
  await follows(page);
  await listener.tracked(100);
  await follows(page);
  const grown = memory() - before;
  console.log(`with 8 clients that never read: ${grown.toFixed(1)} MB more`);
  assert.ok(grown < 40, "the queues of clients are bounded");
  for (const socket of idle) socket.destroy();
  await close();
});

test("a page beyond the limit waits", LONG, async () => {
  const others = [];
  const oneMore = async () => {
    const socket = new WebSocket(`ws://localhost:${program.port}/ws`, { perMessageDeflate: false });
    const admitted = await Promise.race([
      once(socket, "message").then(() => true),
      once(socket, "close").then(() => false),
    ]);
    if (!admitted) return false;
    for (const type of ["pictures", "poses"]) socket.send(JSON.stringify({ type, on: false }));
    others.push(socket);
    return true;
  };
  // Twice: a page of an earlier test may still be connected.
  for (let i = 0; i < 2; i++) {
    while (await oneMore()) assert.ok(others.length <= 40);
    await pause(500);
  }
  const { page, close } = await openPage(flat, program);
  const banner = page.locator("#banner");
  await banner.filter({ hasText: "Too many pages are open" }).waitFor();
  assert.doesNotMatch(await banner.innerText(), /still running/);
  assert.equal(await page.evaluate(() => window.telemime.phase), "disconnected");
  for (const socket of others) socket.close();
  await follows(page); // by itself
  assert.equal(await banner.isVisible(), false);
  await close();
});

test("another version is reported", LONG, async () => {
  const { page, close } = await openPage(flat, program);
  await page.routeWebSocket(/./, (socket) => {
    const server = socket.connectToServer();
    server.onMessage((data) => {
      socket.send(data);
      if (/"type":"hello"/.test(data)) socket.send(data.replace(/"version":"[^"]*"/, '"version":"next"'));
    });
  });
  await page.reload();
  await page
    .locator(".toast.warning")
    .filter({ hasText: "Telemime was updated. Reload the page." })
    .waitFor();
  await close();
});

test("the page finds a restarted program", LONG, async () => {
  const { page, close } = await openPage(browser, program);
  await follows(page);
  await hasAvatar(page, "Plain");
  listener.close();
  await program.kill();
  await page.locator("#banner").filter({ hasText: "No connection to Telemime" }).waitFor();
  assert.equal(await page.evaluate(() => window.telemime.phase), "disconnected");
  for (const id of ["#gauge-tracked", "#gauge-median", "#gauge-cpu"]) {
    assert.equal(await page.locator(id).textContent(), "–");
  }
  await page.waitForFunction(() => window.telemime.counters.rest === 1); // the avatar goes to rest
  program = all.program = await startProgram(["demo", ...LIGHT], { port: program.port });
  listener = all.listener = await Listener.open(program);
  await follows(page);
  await page.waitForFunction(() => window.telemime.counters.rest === 0);
  assert.equal(await page.locator("#banner").isVisible(), false);
  await close();
});
