#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Estimates on paper what rooms ask of brokers: messages, bytes, cores and memory, from assumptions that it prints.

    scripts/room_estimate.py                              10,000 rooms of 20
    scripts/room_estimate.py --rooms 1 --people 30        a class
    scripts/room_estimate.py --set cores_per_million 2 --set moving 1.0

Nothing is measured here. docs/room-scale.md says where each assumption is from.
"""

import argparse
import math

# name -> value, unit, what it is
ASSUMPTIONS = {
    "rooms": (10_000, "", "rooms at the same time"),
    "people": (20, "", "in each room, all of them tracked and all of them looking"),
    "moving": (0.6, "", "part of the time that a person moves; else 2 frames a second"),
    "still_rate": (2, "1/s", "frames of a person who does not move"),
    "frame": (111, "bytes", "a pose of 13 bones"),
    "topic": (38, "bytes", "r/<tenant>/<room>/p/<participant>/pose, as it stands in each message"),
    "mqtt": (4, "bytes", "MQTT 3.1.1: kind, length (1 or 2 bytes), length of the topic"),
    "websocket_out": (4, "bytes", "WebSocket to a browser: head of 4 above 125 bytes"),
    "tls": (22, "bytes", "TLS 1.3 for each record: head 5, kind 1, tag 16"),
    "tcp_ip": (52, "bytes", "TCP with time stamps 32, IPv4 20, for each packet"),
    "ethernet": (38, "bytes", "Ethernet with the gap between packets"),
    "acks": (0.5, "", "packets of pure acknowledgement for each packet; they go the other way and are counted with it"),
    "shared": (1.0, "", "messages for each packet and TLS record: 1 is the worst; brokers write what waits at once"),
    "cores_per_million": (9.0, "cores", "of a broker for a million messages a second, in or out, unencrypted"),
    "tls_factor": (2.0, "", "more work for TLS and small packets of real networks"),
    "headroom": (0.5, "", "part of a node that is used at most, so that two of three can carry all"),
    "node_cores": (16, "cores", "of one node"),
    "node_bits": (10e9, "bit/s", "of one node's network"),
    "connection": (60_000, "bytes", "of memory for a connection with TLS"),
    "retained": (3_000, "bytes", "that a participant leaves at the broker: state, presence, some of the blackboard"),
    "node_base": (200e6, "bytes", "of memory for a node that does nothing"),
    "routed": (0.0, "", "part of the messages in that another node needs, too: 0 when a room is at one node"),
}  # fmt: skip


def pace(people):
    """Frames a second of a participant: docs/room-protocol.md."""
    return min(30.0, max(5.0, 300.0 / people))


def estimate(a):
    """From the assumptions (name -> number): name -> number."""
    rate = a["moving"] * pace(a["people"]) + (1.0 - a["moving"]) * min(a["still_rate"], pace(a["people"]))
    message = a["frame"] + a["topic"] + a["mqtt"]
    # A browser hears itself, too: its filter is the whole room.
    room_in = a["people"] * rate
    room_out = room_in * a["people"]
    packet = a["tls"] + a["tcp_ip"] + a["ethernet"]
    ack = a["acks"] * (a["tcp_ip"] + a["ethernet"])
    wire_up = message + (packet + ack) / a["shared"]
    wire_down = message + a["websocket_out"] + (packet + ack) / a["shared"]
    r = {
        "pace": pace(a["people"]),
        "rate": rate,
        "message": message,
        "wire_up": wire_up,
        "wire_down": wire_down,
        "person_up": rate * wire_up,
        "person_down": room_in * wire_down,
        "room_in": room_in,
        "room_out": room_out,
        "room_bytes_out": room_out * wire_down,
        "in": a["rooms"] * room_in,
        "out": a["rooms"] * room_out,
        "bytes_in": a["rooms"] * room_in * wire_up,
        "bytes_out": a["rooms"] * room_out * wire_down,
        "connections": a["rooms"] * a["people"] * 2,  # a tracker and a page each
    }
    r["bytes_routed"] = a["routed"] * r["in"] * message
    r["cores"] = (r["in"] + r["out"]) / 1e6 * a["cores_per_million"] * a["tls_factor"]
    r["memory"] = r["connections"] * a["connection"] + a["rooms"] * a["people"] * a["retained"]
    by_cores = r["cores"] / (a["node_cores"] * a["headroom"])
    by_network = 8 * (r["bytes_out"] + r["bytes_routed"]) / (a["node_bits"] * a["headroom"])
    r["nodes_by_cores"], r["nodes_by_network"] = math.ceil(by_cores), math.ceil(by_network)
    # A room lives in one cluster of three.
    r["clusters"] = math.ceil(max(r["nodes_by_cores"], r["nodes_by_network"]) / 3)
    r["nodes"] = 3 * r["clusters"]
    r["node_memory"] = a["node_base"] + r["memory"] / r["nodes"]
    return r


def short(value):
    """1234567 as "1.23 M"."""
    for size, unit in ((1e15, " P"), (1e12, " T"), (1e9, " G"), (1e6, " M"), (1e3, " k")):
        if abs(value) >= size:
            return f"{value / size:.3g}{unit}"
    return f"{value:.3g} "


def table(r):
    """Rows of (what, value with unit)."""
    bits = lambda bytes_per_second: short(8 * bytes_per_second) + "bit/s"  # noqa: E731
    return [
        ("pace while moving", f"{r['pace']:.3g} frames/s"),
        ("pace on average", f"{r['rate']:.3g} frames/s"),
        ("a frame as MQTT", f"{r['message']:.0f} bytes"),
        ("a frame on the wire, up / down", f"{r['wire_up']:.0f} / {r['wire_down']:.0f} bytes"),
        ("a participant, up / down", f"{bits(r['person_up'])} / {bits(r['person_down'])}"),
        ("a room, messages in / out", f"{short(r['room_in'])}/s / {short(r['room_out'])}/s"),
        ("a room, out", bits(r["room_bytes_out"])),
        ("all rooms, messages in / out", f"{short(r['in'])}/s / {short(r['out'])}/s"),
        ("all rooms, in / out", f"{bits(r['bytes_in'])} / {bits(r['bytes_out'])}"),
        ("all rooms, out in 30 days", short(r["bytes_out"] * 86400 * 30) + "B if they never end"),
        ("connections", short(r["connections"]).strip()),
        ("between nodes", bits(r["bytes_routed"])),
        ("cores", f"{r['cores']:.3g}"),
        ("memory", short(r["memory"]) + "B"),
        ("nodes by cores / by network", f"{r['nodes_by_cores']} / {r['nodes_by_network']}"),
        ("nodes, in clusters of three", f"{r['nodes']} in {r['clusters']}"),
        ("memory of a node", short(r["node_memory"]) + "B"),
    ]


def assumptions(changed):
    a = {name: float(value) for name, (value, _, _) in ASSUMPTIONS.items()}
    for name, value in changed:
        if name not in a:
            raise SystemExit(f'room_estimate: there is no assumption "{name}"; they are: {", ".join(a)}')
        a[name] = float(value)
        if not a[name] >= 0 or (name not in ("routed", "moving", "acks") and a[name] == 0):
            raise SystemExit(f'room_estimate: "{name}" cannot be {value}')
    return a


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rooms")
    parser.add_argument("--people")
    parser.add_argument("--set", nargs=2, action="append", default=[], metavar=("NAME", "VALUE"))
    options = parser.parse_args()
    given = [(n, v) for n, v in (("rooms", options.rooms), ("people", options.people)) if v is not None]
    a = assumptions(given + options.set)
    print("assumed:")
    for name, (_, unit, words) in ASSUMPTIONS.items():
        print(f"  {name:18} {a[name]:>12,.6g} {unit:6} {words}")
    print("estimated:")
    for what, value in table(estimate(a)):
        print(f"  {what:32} {value}")


if __name__ == "__main__":
    main()
