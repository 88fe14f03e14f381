#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs `telemime live demo` for an hour among pages and receivers that behave badly, and watches its memory.

    scripts/live_soak.py build/release/telemime                   an hour
    scripts/live_soak.py build/release/telemime --seconds 180     a try

Around the program: a page that reads, a page that never reads, pages that come and go, pages that are hidden,
a page that says nonsense; a VMC receiver and a BAP receiver that die and come back; a recording in part of the time,
which is downloaded and deleted. Fails (exit code 1) when the memory after the warm-up (five minutes, or a third of a
shorter run) grows by more than --bound MB; when there are never again as few file descriptors in the last third as
there were at most in the warm-up; when the program ends or complains (any word of it but those in EXPECTED); and when
the page that reads is thrown out or hears nothing for 20 s. Everything stays on this machine; Python's own library is
all it needs.
"""

import argparse
import asyncio
import contextlib
import json
import os
import random
import re
import signal
import sys
import tempfile
import time

from web_socket import WebSocket


# With --quiet the program says warnings and errors alone. These are no faults of it: the tracker's doubts about the
# clip's person. On a computer that is busy with other work, few of the clip's frames are seen, and the person's
# jumps may look like a small change of light. And the receivers die here.
EXPECTED = (r"the light changed by -?\d %", r"^(vmc|bap\+tcp)://127\.0\.0\.1:\d+: ")


class Soak:
    def __init__(self, options):
        self.options = options
        self.port = 0
        self.process = None
        self.counts = {}
        self.failures = []
        self.heard_at = time.monotonic()
        self.longest_silence = 0.0
        self.begun = time.monotonic()
        self.samples = []
        self.status = {}
        self.over = False

    def count(self, what, by=1):
        self.counts[what] = self.counts.get(what, 0) + by

    def fail(self, words):
        print("FAILED:", words, flush=True)
        self.failures.append(words)

    # -- the program

    async def start(self, folder, vmc, bap):
        self.process = await asyncio.create_subprocess_exec(
            self.options.program, "live", self.options.input, "--port", "0", "--no-settings",
            "--recordings", os.path.join(folder, "recordings"),
            "--send", f"vmc://127.0.0.1:{vmc}", "--send", f"bap+tcp://127.0.0.1:{bap}",
            "--seconds", str(self.options.seconds + 60), "--quiet",
            stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE,
        )  # fmt: skip
        line = ""
        while not (found := re.search(r"localhost:(\d+)", line)):
            line = (await self.process.stdout.readline()).decode()
            if not line:
                raise SystemExit("the program does not start: " + (await self.process.stderr.read()).decode())
        self.port = int(found.group(1))
        self.words = asyncio.create_task(self.listen())

    async def listen(self):
        while line := await self.process.stderr.readline():
            words = line.decode(errors="replace").rstrip()
            print("program:", words, flush=True)
            if not any(re.search(expected, words) for expected in EXPECTED):
                self.fail("the program complains: " + words)

    def memory(self):
        """MB that the program holds; descriptors that it has open."""
        with open(f"/proc/{self.process.pid}/status", encoding="ascii") as status:
            kb = int(re.search(r"VmRSS:\s+(\d+)", status.read()).group(1))
        return kb / 1024, len(os.listdir(f"/proc/{self.process.pid}/fd"))

    # -- pages

    @contextlib.asynccontextmanager
    async def page(self, **options):
        """An open page, which is closed in any case."""
        page = await WebSocket.open(self.port, **options)
        try:
            yield page
        finally:
            await page.close()

    async def reads(self):
        """A page as it should be; it also reports what it drew."""
        asked = 0.0
        async with self.page() as page:
            while not self.over:
                message = await page.hear()
                silent, self.heard_at = time.monotonic() - self.heard_at, time.monotonic()
                self.longest_silence = max(self.longest_silence, silent)
                if isinstance(message, bytes):
                    self.count("pictures")
                    continue
                self.count(message["type"])
                if message["type"] == "pose":
                    page.say({"type": "drawn", "frame": message["frame"], "stamp": message["stamp"]})
                elif message["type"] == "status":
                    self.status = message
                elif message["type"] == "message" and message["level"] == "error":
                    self.fail("the page gets the error: " + message["words"])
                if time.monotonic() - asked > 4:
                    asked = time.monotonic()
                    page.say({"type": "ping", "id": int(asked)})
                await page.writer.drain()

    async def never_reads(self):
        """Stalls until the program closes it, and comes again."""
        # A small limit: asyncio stops taking bytes off the socket when twice as many wait.
        async with self.page(limit=2**10):
            self.count("pages that never read")
            await asyncio.sleep(90)

    async def come_and_go(self):
        await asyncio.gather(*(self.looks_around() for _ in range(random.randint(1, 8))))
        await asyncio.sleep(random.uniform(0.0, 2.0))

    async def looks_around(self):
        """Reads for some seconds. Some are hidden for a time; some say nonsense."""
        async with self.page() as page:
            self.count("pages that came and went")
            kind = random.randrange(4)
            if kind == 0:
                self.count("pages that were hidden")
                page.say({"type": "pictures", "on": False})
                page.say({"type": "poses", "on": False})
                await page.read_for(random.uniform(0.0, 5.0))
                page.say({"type": "pictures", "on": True})
                page.say({"type": "poses", "on": True})
            elif kind == 1:
                for _ in range(20):
                    page.say(random.choice(["{{{", "[]", '{"type":"dance"}', "\x01", '{"type":"drawn"}']))
            await page.read_for(random.uniform(0.0, 5.0))

    async def get(self, path):
        reader, writer = await asyncio.open_connection("127.0.0.1", self.port)
        writer.write(f"GET {path} HTTP/1.1\r\nHost: localhost:{self.port}\r\nConnection: close\r\n\r\n".encode())
        head = await reader.readuntil(b"\r\n\r\n")
        size = 0
        while part := await reader.read(2**16):
            size += len(part)
        writer.close()
        if b" 200 " not in head.split(b"\r\n")[0]:
            self.fail(f"{path} is answered {head.splitlines()[0]!r}")
        stated = re.search(rb"Content-Length: (\d+)", head)
        if not stated or int(stated.group(1)) != size:
            self.fail(f"{path} has {size} bytes, not as stated")
        self.count("downloads")

    async def records(self):
        """In a tenth of the time, from the middle of the warm-up on: recorded, downloaded, deleted."""
        period = min(300.0, self.options.seconds / 6)
        await asyncio.sleep(0.45 * period)
        async with self.page() as page:
            page.say({"type": "pictures", "on": False})
            page.say({"type": "record", "on": True})
            await page.read_for(0.1 * period)
            page.say({"type": "record", "on": False})
            await page.settle()
        until = time.monotonic() + 20
        while not self.status.get("recordings") and time.monotonic() < until:
            await asyncio.sleep(0.2)
        if not self.status.get("recordings"):
            self.fail("no recording has come of it")
        for recording in self.status.get("recordings", []):
            for file in recording["files"]:
                await self.get(f"/recordings/{recording['number']}/{file['name']}")
            async with self.page() as page:
                page.say({"type": "forget", "recording": recording["number"]})
                await page.settle()
        self.count("recordings")
        await self.get("/")
        await self.get("/avatars/robot.vrm")
        await asyncio.sleep(0.35 * period)

    # -- receivers

    async def receives_vmc(self, port):
        """Datagrams, for some time; then the port is closed for some time."""
        soak = self

        class Receiver(asyncio.DatagramProtocol):
            def datagram_received(self, data, addr):
                soak.count("VMC datagrams")

        loop = asyncio.get_running_loop()
        transport, _ = await loop.create_datagram_endpoint(Receiver, local_addr=("127.0.0.1", port))
        await asyncio.sleep(random.uniform(10, 30))
        transport.close()
        await asyncio.sleep(random.uniform(2, 15))
        self.count("VMC receivers")

    async def receives_bap(self, port):
        """Reads lines, or never reads, or dies with a reset; then it is gone for some time."""
        clients = []
        server = await asyncio.start_server(lambda r, w: clients.append((r, w)), "127.0.0.1", port)
        stalls = random.random() < 0.3
        until = time.monotonic() + random.uniform(10, 30)
        while time.monotonic() < until:
            if not clients or stalls:
                await asyncio.sleep(0.2)
                continue
            try:
                line = await asyncio.wait_for(clients[-1][0].readline(), 1)
                self.count("BAP lines", 1 if line else 0)
                if not line:
                    await asyncio.sleep(0.2)
            except (asyncio.TimeoutError, ConnectionError, ValueError):
                pass
        server.close()
        for _, writer in clients:
            writer.transport.abort()
        await asyncio.sleep(random.uniform(2, 15))
        self.count("BAP receivers")

    # -- the watch

    def look(self):
        seconds = time.monotonic() - self.begun
        megabytes, descriptors = self.memory()
        self.samples.append((seconds, megabytes, descriptors))
        print(
            f"{seconds / 60:6.1f} min  {megabytes:7.1f} MB  {descriptors:3d} descriptors  "
            f"phase {self.status.get('phase')}  {self.status.get('fps', {}).get('tracked')} a second",
            flush=True,
        )
        self.longest_silence = max(self.longest_silence, time.monotonic() - self.heard_at)

    async def watch(self):
        step = min(60.0, self.options.seconds / 18)
        while time.monotonic() - self.begun < self.options.seconds:
            await asyncio.sleep(step)
            if self.process.returncode is not None:
                self.fail(f"the program ended by itself, with code {self.process.returncode}")
                return
            self.look()

    def judge(self):
        warm = min(300.0, self.options.seconds / 3)
        base = [m for t, m, _ in self.samples if t <= warm]
        later = [m for t, m, _ in self.samples if t > warm]
        if not base or not later:
            self.fail("too few looks at the memory")
            return
        growth = max(later) - max(base)
        print(f"memory: at most {max(base):.1f} MB in the warm-up, {max(later):.1f} MB later: {growth:+.1f} MB")
        if growth > self.options.bound:
            self.fail(f"the memory grew by {growth:.1f} MB, more than {self.options.bound} MB")
        most = max(d for t, _, d in self.samples if t <= warm)
        least = min(d for t, _, d in self.samples if t >= self.samples[-1][0] * 2 / 3)
        print(f"descriptors: at most {most} in the warm-up, at least {least} in the last third")
        if least > most:
            self.fail(f"file descriptors stay open: at least {least} in the last third, {most} in the warm-up")
        print(f"the page that reads heard nothing for {self.longest_silence:.1f} s at most")
        if self.longest_silence > 20:
            self.fail("the page that reads has heard nothing for more than 20 s")
        for what in ("pose", "pictures", "VMC datagrams", "BAP lines", "recordings"):
            if not self.counts.get(what):
                self.fail(f"no {what} came at all")

    async def repeated(self, what, work, may_fail=True):
        """Does the work again and again, also when the program has closed its connection, if it may do that."""
        while not self.over:
            try:
                await work()
            except (ConnectionError, OSError, asyncio.IncompleteReadError) as error:
                if not may_fail and not self.over:
                    self.fail(f"{what} was thrown out: {error!r}")
                self.count(f"{what}: {type(error).__name__}")
                await asyncio.sleep(1)

    async def run(self):
        vmc, bap = free_ports(2)
        with tempfile.TemporaryDirectory(prefix="telemime-soak-") as folder:
            await self.start(folder, vmc, bap)
            self.begun = self.heard_at = time.monotonic()
            helpers = [
                asyncio.create_task(self.repeated(*task))
                for task in (
                    ("the page that reads", self.reads, False),
                    ("the page that never reads", self.never_reads),
                    ("pages that come and go", self.come_and_go),
                    ("the page that records", self.records, False),
                    ("VMC", lambda: self.receives_vmc(vmc)),
                    ("BAP", lambda: self.receives_bap(bap)),
                )
            ]
            await self.watch()
            self.over = True
            for task in helpers:
                task.cancel()
            for result in await asyncio.gather(*helpers, return_exceptions=True):
                if isinstance(result, Exception) and not isinstance(result, asyncio.CancelledError):
                    self.fail(f"the soak itself failed: {result!r}")
            if self.process.returncode is None:
                self.process.send_signal(signal.SIGINT)
                try:
                    rest = await asyncio.wait_for(self.process.stdout.read(), 30)
                    code = await asyncio.wait_for(self.process.wait(), 30)
                    print(rest.decode())
                    if code != 0:
                        self.fail(f"exit code {code} after Ctrl-C")
                except asyncio.TimeoutError:
                    self.process.kill()
                    self.fail("the program does not end within 30 s of Ctrl-C")
            await asyncio.wait_for(self.words, 30)  # the program has ended: so do its words
        self.judge()
        print(", ".join(f"{what} {count}" for what, count in sorted(self.counts.items())))
        return 1 if self.failures else 0


def free_ports(count):
    """Ports that nobody listens at, a moment ago."""
    import socket

    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="the program telemime")
    parser.add_argument("--seconds", type=float, default=3600.0, help="how long [3600]")
    parser.add_argument("--bound", type=float, default=30.0, help="MB of growth after the warm-up [30]")
    parser.add_argument("--input", default="demo", help="of telemime live [demo]")
    options = parser.parse_args()
    soak = Soak(options)
    code = asyncio.run(soak.run())
    print("passed" if code == 0 else "failed: " + "; ".join(soak.failures))
    sys.exit(code)


if __name__ == "__main__":
    main()
