#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""scripts/room_estimate.py: cases that can be worked out by hand."""

import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
import room_estimate as estimate  # noqa: E402


def of(**changed):
    return estimate.estimate(estimate.assumptions(changed.items()))


class Estimate(unittest.TestCase):
    def test_pace_is_the_protocols(self):
        for people, pace in ((1, 30), (10, 30), (20, 15), (30, 10), (60, 5), (1000, 5)):
            self.assertEqual(estimate.pace(people), pace)

    def test_a_class_worked_out_by_hand(self):
        r = of(rooms=1, people=30, moving=1, shared=1)
        self.assertEqual(r["rate"], 10)
        self.assertEqual(r["message"], 111 + 38 + 4)
        self.assertEqual(r["room_in"], 300)
        self.assertEqual(r["room_out"], 9000)
        up = 153 + 22 + 52 + 38 + 0.5 * (52 + 38)
        self.assertEqual(r["wire_up"], up)
        self.assertEqual(r["wire_down"], up + 4)
        self.assertAlmostEqual(r["person_up"], 10 * up)
        self.assertAlmostEqual(r["person_down"], 300 * (up + 4))
        self.assertAlmostEqual(r["bytes_out"], 30 * r["person_down"])
        self.assertEqual(r["connections"], 60)
        self.assertEqual((r["nodes"], r["clusters"]), (3, 1))

    def test_still_people_send_twice_a_second(self):
        self.assertEqual(of(moving=0)["rate"], 2)
        self.assertAlmostEqual(of(moving=0.5, people=20)["rate"], 0.5 * 15 + 0.5 * 2)

    def test_rooms_add_up(self):
        one, many = of(rooms=1), of(rooms=1000)
        for what in ("in", "out", "bytes_in", "bytes_out", "cores", "connections", "memory"):
            self.assertAlmostEqual(many[what], 1000 * one[what], delta=1e-6 * many[what])

    def test_nodes_carry_what_is_asked_with_headroom(self):
        r = of()
        a = estimate.assumptions(())
        self.assertEqual(r["nodes"], 3 * r["clusters"])
        self.assertGreaterEqual(r["nodes"] * a["node_cores"] * a["headroom"], r["cores"])
        self.assertGreaterEqual(r["nodes"] * a["node_bits"] * a["headroom"], 8 * r["bytes_out"])
        fewer = (r["clusters"] - 1) * 3
        self.assertTrue(
            fewer * a["node_cores"] * a["headroom"] < r["cores"]
            or fewer * a["node_bits"] * a["headroom"] < 8 * r["bytes_out"]
        )

    def test_messages_that_share_a_packet_cost_less(self):
        self.assertLess(of(shared=3)["bytes_out"], of(shared=1)["bytes_out"])
        self.assertEqual(of(shared=3)["out"], of(shared=1)["out"])

    def test_the_page_shows_what_the_script_says(self):
        page = (Path(__file__).resolve().parents[2] / "docs" / "room-scale.md").read_text()
        for what, value in estimate.table(of()):
            self.assertIn(f"| {what} | {value} |", page)

    def test_unknown_or_impossible_assumptions_are_refused(self):
        for bad in (("roms", 1), ("people", 0), ("shared", -1)):
            with self.assertRaises(SystemExit):
                estimate.assumptions([bad])

    def test_short(self):
        self.assertEqual(estimate.short(1234567), "1.23 M")
        self.assertEqual(estimate.short(12.5), "12.5 ")


if __name__ == "__main__":
    unittest.main()
