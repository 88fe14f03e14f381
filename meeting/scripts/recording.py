#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Shows the contents of a recording of a meeting (docs/recording.md). Shares no code with the program.

    scripts/recording.py lesson.troom             summary
    scripts/recording.py lesson.troom --lines     each record as a line of JSON, poses in hexadecimal

Problems with the end of the file go to standard error. Exit code 1: it is not a recording of version 1.
"""

import argparse
import collections
import json
import signal
import struct
import sys
import zlib

MAGIC = b"TROOM\r\n\x1a"
WHAT = ["pose", "state", "presence", "chat", "board", "room"]
NOBODY = 65535


def refuse(words):
    raise SystemExit(f"recording: {words}")


def complain(words):
    print(f"recording: {words}", file=sys.stderr)


def records(file):
    """Kind and body of each record. Reports a damaged or missing end on standard error."""
    head = file.read(12)
    if head[:8] != MAGIC:
        refuse("it is not a recording of a meeting")
    if head[8:] != struct.pack("<I", 1):
        refuse("this recording has another version")
    at = 12
    ended = False
    while start := file.read(7):
        if ended:
            return complain(f"there is data after the end, at byte {at}")
        if len(start) < 7:
            return complain(f"it is truncated at byte {at}")
        kind, size, crc = struct.unpack("<cHI", start)
        body = file.read(size)
        if len(body) < size:
            return complain(f"it is truncated at byte {at}")
        if zlib.crc32(start[:3] + body) != crc:
            return complain(f"it is damaged at byte {at}")
        at += 7 + size
        ended = kind == b"E"
        yield kind.decode("latin-1"), body
    if not ended:
        complain("the recording was not closed properly")
    return None


def text_of(payload):
    try:
        return payload.decode()
    except UnicodeDecodeError:
        return payload.hex()


def objects(file):
    """Each record except names, as an object."""
    names = []
    for kind, body in records(file):
        if kind == "S":
            yield {"kind": "start", **json.loads(body)}
        elif kind == "N":
            names.append(body[2:].decode())
        elif kind == "M":
            at, what, page, number = struct.unpack("<QBBH", body[:12])
            out = {"kind": WHAT[what], "at_us": at}
            if number != NOBODY:
                out["participant"] = names[number]
            if WHAT[what] == "board":
                out["page"] = page
            out["payload"] = body[12:].hex() if what == 0 else text_of(body[12:])
            yield out
        elif kind == "L":
            yield {"kind": "lost", "at_us": struct.unpack("<Q", body[:8])[0], "words": text_of(body[8:])}
        elif kind == "D":
            at, count = struct.unpack("<QI", body)
            yield {"kind": "dropped", "at_us": at, "count": count}
        elif kind in "BE":
            yield {"kind": {"B": "back", "E": "end"}[kind], "at_us": struct.unpack("<Q", body)[0]}


def summarise(file):
    people = collections.defaultdict(collections.Counter)
    names = collections.defaultdict(set)
    others = collections.Counter()
    last = 0
    for record in objects(file):
        last = record.get("at_us", last)
        if record["kind"] == "start":
            print(f"meeting {record['tenant']}/{record['room']}, recorded {record['began']}")
        elif "participant" in record:
            people[record["participant"]][record["kind"]] += 1
            if record["kind"] == "state" and record["payload"]:
                try:
                    names[record["participant"]].add(str(json.loads(record["payload"])["name"]))
                except (ValueError, KeyError, TypeError, RecursionError):
                    pass
        else:
            others[record["kind"]] += record.get("count", 1)
    print(f"{last / 1e6:.1f} s")
    for participant, counts in sorted(people.items()):
        title = " ".join([participant, *(json.dumps(n) for n in sorted(names[participant]))])
        print(f"{title}: " + ", ".join(f"{counts[what]} {what}" for what in WHAT if counts[what]))
    for what, count in sorted(others.items()):
        if what not in ("end", "back"):
            print(f"{what}: {count}")


def main():
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file")
    parser.add_argument("--lines", action="store_true")
    options = parser.parse_args()
    try:
        with open(options.file, "rb") as file:
            if options.lines:
                for record in objects(file):
                    print(json.dumps(record, ensure_ascii=False))
            else:
                summarise(file)
    except OSError as error:
        refuse(error)


if __name__ == "__main__":
    main()
