#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""scripts/cluster.py: what it writes. tests/broker runs it with real nodes."""

import json
import re
import stat
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "scripts" / "cluster.py"
sys.path.insert(0, str(SCRIPT.parent))
import cluster  # noqa: E402

NODES = ["--nodes", "a.example.org,b.example.org,c.example.org"]
TLS = ["--certificate", "/etc/meeting/cert.pem", "--key", "/etc/meeting/key.pem"]


def make(folder, *words):
    done = subprocess.run([sys.executable, SCRIPT, "make", folder, *words], capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


class Cluster(unittest.TestCase):
    def setUp(self):
        self.root = tempfile.TemporaryDirectory()
        self.folder = Path(self.root.name) / "cluster"

    def tearDown(self):
        self.root.cleanup()

    def test_three_nodes_know_each_other(self):
        self.assertEqual(make(self.folder, *NODES, *TLS)[0], 0)
        told = json.loads((self.folder / "cluster.json").read_text())
        self.assertEqual(told["topic"], "r/home/studio")
        self.assertEqual([n["mqtt"] for n in told["nodes"]], [f"mqtts://{h}.example.org:8883" for h in "abc"])
        self.assertEqual([n["ws"] for n in told["nodes"]], [f"wss://{h}.example.org:443/mqtt" for h in "abc"])
        for number, others in ((1, "bc"), (2, "ac"), (3, "ab")):
            text = (self.folder / f"node{number}.conf").read_text()
            routes = re.findall(r"@(\w)\.example\.org:6222", text)
            self.assertEqual("".join(routes), others)
            self.assertEqual(text.count("/etc/meeting/cert.pem"), 2, "trackers' and browsers' listeners")
            for line in ('write_deadline: "2s"', "max_payload: 65536", "stream_replicas: 3"):
                self.assertIn(line, text)

    def test_accounts_publish_their_own_topics(self):
        self.assertEqual(make(self.folder, "--loopback", "--tenant", "t", "--meeting", "m", "--participants", "3")[0], 0)
        text = (self.folder / "accounts.conf").read_text()
        rules = dict(re.findall(r'user: "m\.(\w+)".*?publish: (\[.*?\]|\{.*?\})', text, re.S))
        may = json.loads(rules["p01"])
        for own in ("pose", "state", "presence", "chat", "board.0", "board.63"):
            self.assertIn(f"r.t.m.p.p01.{own}", may)
        self.assertIn("r.t.m.room", may)
        self.assertEqual(len(may), 4 + 64 + 1)
        self.assertFalse([s for s in may if ">" in s or "*" in s], "no more than that is ever kept")
        self.assertEqual(json.loads(rules["p03"]), [s.replace("p01", "p03") for s in may if s != "r.t.m.room"])
        self.assertEqual(rules["watch"], '{ deny: ">" }')
        self.assertEqual(rules["service"], '["r.t.m.>"]')
        self.assertEqual(set(re.findall(r"subscribe: (\[.*?\])", text)), {'["r.t.m", "r.t.m.>", "$MQTT.sub.>"]'})

    def test_passwords_are_private(self):
        self.assertEqual(make(self.folder, "--loopback")[0], 0)
        keys = {f: json.loads(f.read_text()) for f in (self.folder / "keys").iterdir()}
        self.assertEqual(len(keys), 10)
        self.assertEqual(len({k["password"] for k in keys.values()}), 10)
        for file in self.folder.rglob("*"):
            if file.is_file():
                self.assertTrue(file in keys or not any(k["password"] in file.read_text() for k in keys.values()))
                secret = file.name != "cluster.json"
                self.assertEqual(stat.S_IMODE(file.stat().st_mode), 0o600 if secret else 0o644, file)
        self.assertEqual(stat.S_IMODE((self.folder / "keys").stat().st_mode), 0o700)

    def test_hashes_are_bcrypt_and_differ(self):
        a, b = cluster.bcrypt("secret"), cluster.bcrypt("secret")
        self.assertNotEqual(a, b)
        for made in (a, b):
            self.assertRegex(made, r"^\$2b\$05\$[./A-Za-z0-9]{53}$")

    def test_invalid_options_are_rejected(self):
        for words, told in (
            ([], "Give --nodes"),
            (["--loopback", *NODES], "Give --nodes"),
            (["--nodes", "a,b"], "3 different hosts"),
            (["--nodes", "a,b,b"], "3 different hosts"),
            (["--nodes", 'a,b,c" }'], "3 different hosts"),
            (["--loopback", "--meeting", 'x" }'], "cannot name a meeting"),
            (["--loopback", "--participants", "0"], "1 to 99"),
            ([*NODES, "--certificate", "x"], "needs its --key"),
        ):
            code, said = make(self.folder, *words)
            self.assertEqual(code, 1)
            self.assertIn(told, said)
        self.assertEqual(make(self.folder, "--loopback")[0], 0)
        code, said = make(self.folder, "--loopback")
        self.assertEqual((code, "not empty" in said), (1, True))


if __name__ == "__main__":
    unittest.main()
