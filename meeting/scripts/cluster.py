#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the configuration of a broker cluster of three `nats-server` nodes for one meeting, and runs it for a try.

    scripts/cluster.py make cluster --tenant home --meeting studio --participants 30 \\
        --nodes a.example.org,b.example.org,c.example.org --certificate /etc/meeting/cert.pem --key /etc/meeting/key.pem
    scripts/cluster.py make cluster --loopback       three nodes on free ports of this computer
    scripts/cluster.py run cluster                   runs the nodes of a folder made with --loopback

`make` writes into a new folder: node1.conf to node3.conf, accounts.conf (the same for all nodes; it has no password, but
bcrypt hashes of them), cluster.json (where the nodes are) and keys/ACCOUNT.json, one for each account: give p01.json to
whom p01 is, as `--send 'mqtt://HOST/home/studio?key=p01.json'`. Files with hashes or passwords can be read by their owner
alone. The accounts are p01, p02 ... who take part (p01 is the chair), `watch`, who only reads, and `service`, who keeps the
meeting's own topic. See docs/cluster.md. Python's own library and the system's libcrypt are all it needs.
"""

import argparse
import contextlib
import ctypes
import ctypes.util
import json
import os
import re
import secrets
import shutil
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

NODES = 3
SEGMENT = re.compile(r"[a-z0-9_-]{1,32}")
HOST = re.compile(r"[A-Za-z0-9.-]{1,253}")
# Passwords are random and of 192 bits: nobody guesses them, so a hash need not be slow. A slow one would keep a node
# busy when a whole meeting reconnects at once (2^11, the usual cost, is 0.1 s for each).
BCRYPT_COST = 5
BOARD_PAGES = 64  # docs/protocol.md
BCRYPT_DIGITS = "./ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789"

NODE = """\
# SPDX-License-Identifier: Apache-2.0
# Node {number} of {count}: nats-server -c {file}
server_name: {name}

# NATS's own protocol and the statistics of this node: for this computer only.
listen: "{private}:{port}"
http: "{private}:{http}"

# A participant who stops reading is disconnected: nothing can be written for 2 s, or this much waits. The largest burst
# is the retained messages for a newcomer to a full meeting: blackboards, states and presences.
write_deadline: "2s"
max_pending: 4MB
# The largest message is a page of a blackboard, 16 KB.
max_payload: 65536
max_connections: 5000

# JetStream stores the retained messages on all nodes. Two of three must run.
jetstream {{
  store_dir: "{store}"
  max_memory_store: 64MB
  max_file_store: 1GB
}}

# Trackers.
mqtt {{
  host: "{public}"
  port: {mqtt}
  stream_replicas: {count}
{mqtt_tls}}}

# Browsers, at the path /mqtt.
websocket {{
  host: "{public}"
  port: {ws}
{ws_tls}}}

# Between the nodes. This is not encrypted: use a private network (WireGuard), or add a `tls` block as in
# deploy/nats/node.conf.
cluster {{
  name: room
  listen: "{routes_host}:{route}"
  authorization {{ user: node, password: "{route_password}" }}
  routes: [
{routes}
  ]
}}

include "accounts.conf"
"""


class Failed(Exception):
    """An error message for the user."""


def subject(topic):
    """The NATS subject of an MQTT topic."""
    return topic.replace("/", ".")


def bcrypt(password):
    """The bcrypt hash of a password, by the system's libcrypt."""
    library = ctypes.CDLL(ctypes.util.find_library("crypt") or "libcrypt.so.1")
    library.crypt.restype = ctypes.c_char_p
    library.crypt.argtypes = [ctypes.c_char_p, ctypes.c_char_p]
    # The last of the 22 digits has only 2 bits.
    salt = "".join(secrets.choice(BCRYPT_DIGITS) for _ in range(21)) + secrets.choice(".Oeu")
    made = library.crypt(password.encode(), f"$2b${BCRYPT_COST:02d}${salt}".encode())
    if not made or not made.startswith(b"$2b$") or len(made) != 60:
        raise Failed("this system's libcrypt cannot make bcrypt hashes; Debian 12 and 13 can.")
    return made.decode()


def accounts_of(tenant, meeting, participants):
    """Account names -> topics that they may publish to."""
    topic = f"r/{tenant}/{meeting}"
    # Listed one by one: a wildcard would allow any number of retained messages.
    own = ["pose", "state", "presence", "chat", *(f"board/{page}" for page in range(BOARD_PAGES))]
    all_of = {p: [f"{topic}/p/{p}/{what}" for what in own] for p in (f"p{i + 1:02d}" for i in range(participants))}
    all_of["p01"].append(f"{topic}/room")
    return {**all_of, "watch": [], "service": [f"{topic}/#"]}


def publish_rule(topics):
    """The publish permission of an account for NATS. `a/#` becomes `a.>` only: nobody publishes on `a`."""
    if not topics:
        return '{ deny: ">" }'
    return "[" + ", ".join(json.dumps(subject(t).replace("#", ">")) for t in topics) + "]"


def accounts_file(tenant, meeting, accounts, passwords):
    """accounts.conf. Each meeting is an account of NATS, so that its messages do not exist for others."""
    base = subject(f"r/{tenant}/{meeting}")
    lines = [
        "# SPDX-License-Identifier: Apache-2.0",
        f"# Permissions in r/{tenant}/{meeting}. The same file for all nodes; `nats-server --signal reload` reads it again.",
        "accounts {",
        f'  "{tenant}.{meeting}": {{',
        "    jetstream: enabled",
        "    users: [",
    ]
    # MQTT's QoS 1 goes through subjects of the gateway's own, below $MQTT.sub; a client cannot name them in a filter.
    subscribe = json.dumps([base, f"{base}.>", "$MQTT.sub.>"])
    for name, topics in accounts.items():
        lines += [
            f'      {{ user: "{meeting}.{name}", password: "{bcrypt(passwords[name])}",',
            '        allowed_connection_types: ["MQTT", "MQTT_WS"],',
            f"        permissions: {{ publish: {publish_rule(topics)}, subscribe: {subscribe} }} }},",
        ]
    # Only the nodes need the system account; without a user nobody can log in to it.
    lines += ["    ]", "  }", "  SYS: {}", "}", "system_account: SYS"]
    return "\n".join(lines) + "\n"


def free_ports(count):
    """Ports of this computer that nobody listens at now."""
    with contextlib.ExitStack() as stack:
        made = [stack.enter_context(socket.socket()) for _ in range(count)]
        for s in made:
            s.bind(("127.0.0.1", 0))
        return [s.getsockname()[1] for s in made]


def places(options):
    """Host and ports of each node."""
    names = ("port", "http", "mqtt", "ws", "route")
    if options.loopback:
        ports = free_ports(NODES * len(names))
        rows = [ports[i * len(names) : (i + 1) * len(names)] for i in range(NODES)]
        return [{"host": "127.0.0.1", **dict(zip(names, row))} for row in rows]
    tls = options.certificate is not None
    usual = (4222, 8222, 8883 if tls else 1883, 443 if tls else 9001, 6222)
    return [{"host": host, **dict(zip(names, usual))} for host in options.nodes]


def tls_block(options):
    if options.certificate is None:
        return ""
    return f"  tls {{ cert_file: {json.dumps(options.certificate)}, key_file: {json.dumps(options.key)} }}\n"


def write(path, text, secret=False):
    with open(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600 if secret else 0o644), "w") as file:
        file.write(text)


def check(options):
    for what in (options.tenant, options.meeting):
        if not SEGMENT.fullmatch(what):
            raise Failed(f'"{what}" cannot name a meeting: use 1 to 32 lower-case letters, digits, _ and -.')
    if not 1 <= options.participants <= 99:
        raise Failed("A meeting has 1 to 99 participants.")
    if options.loopback == bool(options.nodes):
        raise Failed("Give --nodes A,B,C, or --loopback for a try on this computer.")
    if not options.loopback and (
        len(set(options.nodes)) != NODES or not all(HOST.fullmatch(n) for n in options.nodes)
    ):
        raise Failed(f"Give {NODES} different hosts with --nodes.")
    if (options.certificate is None) != (options.key is None):
        raise Failed("A certificate needs its --key, and a key its --certificate.")


def make(options):
    """Writes the folder. Nothing in it is replaced."""
    check(options)
    folder = Path(options.folder)
    if folder.exists() and any(folder.iterdir()):
        raise Failed(f"{folder} is there already and not empty; give another name.")
    (folder / "keys").mkdir(parents=True, mode=0o700)
    accounts = accounts_of(options.tenant, options.meeting, options.participants)
    passwords = {name: secrets.token_urlsafe(24) for name in accounts}
    write(folder / "accounts.conf", accounts_file(options.tenant, options.meeting, accounts, passwords), secret=True)
    for name, password in passwords.items():
        user = f"{options.meeting}.{name}"
        write(folder / "keys" / f"{name}.json", json.dumps({"user": user, "password": password}) + "\n", secret=True)
    nodes = places(options)
    route_password = secrets.token_urlsafe(24)
    tls = tls_block(options)
    for i, node in enumerate(nodes):
        file = f"node{i + 1}.conf"
        others = [f'    "nats://node:{route_password}@{n["host"]}:{n["route"]}"' for n in nodes if n is not node]
        store = (folder / f"store{i + 1}").absolute() if options.loopback else Path("/var/lib/nats/room")
        public = "127.0.0.1" if options.loopback else "0.0.0.0"
        text = NODE.format(
            number=i + 1, count=NODES, file=file, name=f"room-{i + 1}", private="127.0.0.1", public=public,
            routes_host=public, store=store, mqtt_tls=tls, ws_tls=tls or "  no_tls: true\n",
            route_password=route_password, routes="\n".join(others),
            **{k: node[k] for k in ("port", "http", "mqtt", "ws", "route")},
        )  # fmt: skip
        write(folder / file, text, secret=True)
    s = "s" if tls else ""
    told = [
        {
            "config": f"node{i + 1}.conf",
            "mqtt": f"mqtt{s}://{n['host']}:{n['mqtt']}",
            "ws": f"ws{s}://{n['host']}:{n['ws']}/mqtt",
            "http": f"http://127.0.0.1:{n['http']}",
        }
        for i, n in enumerate(nodes)
    ]
    cluster = {"topic": f"r/{options.tenant}/{options.meeting}", "participants": options.participants, "nodes": told}
    write(folder / "cluster.json", json.dumps(cluster, indent=2) + "\n")
    print(f"{folder}: {NODES} nodes, {len(accounts)} accounts; keys/ holds their passwords")


def run(options):
    """Runs the nodes until Ctrl-C, or until one ends."""
    folder = Path(options.folder)
    cluster = json.loads((folder / "cluster.json").read_text())
    server = shutil.which("nats-server", path=f"{os.environ.get('PATH', '')}:/usr/sbin")
    if server is None:
        raise Failed("nats-server is not installed: apt-get install nats-server")
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
    nodes = []
    try:
        for node in cluster["nodes"]:
            with open(folder / f"{node['config']}.log", "ab") as log:
                nodes.append(subprocess.Popen([server, "-c", folder / node["config"]], stdout=log, stderr=log))
            path = cluster["topic"].removeprefix("r/")
            print(f"{node['config']}: trackers {node['mqtt']}/{path}, browsers {node['ws']}")
        print("Ctrl-C ends it", flush=True)
        while all(n.poll() is None for n in nodes):
            time.sleep(0.2)
        raise Failed(f"a node ended; {folder}/*.log says why")
    except KeyboardInterrupt:
        pass
    finally:
        for n in nodes:
            n.terminate()
        for n in nodes:
            n.wait()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    making = commands.add_parser("make", help="writes a new folder")
    making.add_argument("folder")
    making.add_argument("--tenant", default="home")
    making.add_argument("--meeting", "--room", default="studio")
    making.add_argument("--participants", type=int, default=8)
    making.add_argument("--nodes", type=lambda text: text.split(","), help="three hosts, with commas between")
    making.add_argument("--loopback", action="store_true", help="on free ports of this computer, unencrypted")
    making.add_argument("--certificate", help="of the listeners, a PEM file on each node")
    making.add_argument("--key")
    making.set_defaults(do=make)
    running = commands.add_parser("run", help="runs a folder made with --loopback")
    running.add_argument("folder")
    running.set_defaults(do=run)
    options = parser.parse_args()
    try:
        options.do(options)
    except (Failed, OSError) as e:
        print(f"cluster: {e}", file=sys.stderr)
        sys.exit(1)


if __name__ == "__main__":
    main()
