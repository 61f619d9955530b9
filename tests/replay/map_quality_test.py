#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What map_quality answers to input that it cannot use: one line that names it, and a status that is not 0.

usage (inside the workspace's environment): map_quality_test.py --junit FILE
"""
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

from whole_run import find_program, run


def cloud(points):
    header = ("# .PCD v0.7\nVERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\n"
              f"WIDTH {len(points)}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {len(points)}\nDATA binary\n")
    return header.encode() + b"".join(struct.pack("<4f", *point, 1.0) for point in points)


class MapQuality(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.here = Path(self.folder.name)

    def ask(self, *arguments):
        command = [find_program("map_quality"), *map(str, arguments)]
        return subprocess.run(command, capture_output=True, text=True, timeout=60)

    def refused(self, words, *arguments):
        answer = self.ask(*arguments)
        self.assertGreater(answer.returncode, 0, "a crash, or taken")
        for word in words:
            self.assertIn(word, answer.stderr)

    def file(self, name, content):
        path = self.here / name
        path.write_bytes(content)
        return path

    def test_input_that_is_not_there(self):
        self.refused(["name one input"])
        self.refused(["nowhere", "no such folder"], "--record", self.here / "nowhere")
        self.refused(["none.pcd", "cannot be opened"], "--clouds", self.here / "none.pcd")

    def test_clouds_that_are_none(self):
        good = cloud([(0.01 * i, 0.0, 0.0) for i in range(100)])
        self.refused(["text.pcd", "not a point cloud"], "--clouds", self.file("text.pcd", b"no cloud at all\n"))
        self.refused(["cut.pcd", "not a point cloud"], "--clouds", self.file("cut.pcd", good[:-40]))
        self.refused(["empty.pcd", "not a point cloud"], "--clouds", self.file("empty.pcd", b""))
        self.assertEqual(self.ask("--clouds", self.file("good.pcd", good)).returncode, 0)

    def test_options_out_of_range(self):
        good = self.file("good.pcd", cloud([(0.0, 0.0, 0.0)]))
        self.refused(["radius_m", "got 0"], "--clouds", good, "--radius", 0)
        self.refused(["radius_m"], "--clouds", good, "--radius", "nan")
        self.refused(["--sweeps", "1"], "--clouds", good, "--sweeps", 1)
        self.refused(["--cut-margin", "0.7"], "--clouds", good, "--cut-margin", 0.7)
        self.refused(["best"], "--record", self.here, "--poses", "best")
        self.refused(["cannot write", "nowhere"], "--clouds", good, "--json", self.here / "nowhere/a.json")


run(MapQuality, "map_quality", __doc__)
