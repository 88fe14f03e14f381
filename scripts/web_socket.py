# SPDX-License-Identifier: Apache-2.0
"""A WebSocket's client with Python's own library alone, for live_soak.py."""

import asyncio
import base64
import json
import random
import struct


class WebSocket:
    """The client's side of RFC 6455, as far as the live page needs it."""

    def __init__(self, reader, writer):
        self.reader, self.writer = reader, writer

    @staticmethod
    async def open(port, limit=2**20):
        reader, writer = await asyncio.open_connection("127.0.0.1", port, limit=limit)
        key = base64.b64encode(random.randbytes(16)).decode()
        writer.write(
            f"GET /ws HTTP/1.1\r\nHost: localhost:{port}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
            f"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n\r\n".encode()
        )
        head = await reader.readuntil(b"\r\n\r\n")
        if b" 101 " not in head.split(b"\r\n")[0]:
            raise ConnectionError("no WebSocket: " + head.decode(errors="replace"))
        return WebSocket(reader, writer)

    def frame(self, opcode, payload):
        mask = random.randbytes(4)
        size = len(payload)
        head = bytes([0x80 | opcode, 0x80 | (size if size < 126 else 126)])
        if size >= 126:
            head += struct.pack(">H", size)
        self.writer.write(head + mask + bytes(b ^ mask[i % 4] for i, b in enumerate(payload)))

    def say(self, message):
        text = message if isinstance(message, str) else json.dumps(message)
        self.frame(1, text.encode())

    async def hear(self):
        """The next message: a dict, or bytes for a picture."""
        whole, kind = b"", 0
        while True:
            first, second = await self.reader.readexactly(2)
            size = second & 0x7F
            if size > 125:
                size = int.from_bytes(await self.reader.readexactly(2 if size == 126 else 8), "big")
            payload = await self.reader.readexactly(size)
            opcode = first & 0x0F
            if opcode == 9:
                self.frame(10, payload)
            elif opcode == 8:
                raise ConnectionError("the program has closed the page")
            elif opcode != 10:
                kind = kind or opcode
                whole += payload
                if first & 0x80:
                    return json.loads(whole) if kind == 1 else whole

    async def settle(self):
        """Until the program has heard all that was said: closing throws away what is on its way."""
        self.say({"type": "ping", "id": 1})
        await self.writer.drain()
        while True:
            message = await self.hear()
            if isinstance(message, dict) and message["type"] == "pong":
                return

    async def read_for(self, seconds):
        """Reads and forgets. Raises ConnectionError when nothing comes for 20 s."""
        await self.writer.drain()
        until = asyncio.get_running_loop().time() + seconds
        while asyncio.get_running_loop().time() < until:
            try:
                await asyncio.wait_for(self.hear(), 20)
            except asyncio.TimeoutError:
                raise ConnectionError("nothing came for 20 s") from None

    async def close(self):
        self.writer.transport.abort()
