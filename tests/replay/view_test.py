#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Watching a run: the outputs do not depend on it, every display of RViz has its topic, and a picture comes without a display.

usage (inside the workspace's environment): view_test.py --junit FILE [--keep DIR]
"""
import os
import signal
import subprocess
import unittest
import xmlrpc.client
from pathlib import Path

import yaml

from whole_run import LIMIT_S, WholeRun, run

RVIZ = Path(__file__).resolve().parents[2] / "rviz"
TYPES = {"rviz/PointCloud2": "sensor_msgs/PointCloud2", "rviz/MarkerArray": "visualization_msgs/MarkerArray",
         "rviz/Map": "nav_msgs/OccupancyGrid", "rviz/Path": "nav_msgs/Path",
         "rviz/Image": "sensor_msgs/Image", "rviz/Camera": "sensor_msgs/Image"}
DELETE_ALL = 3  # visualization_msgs/Marker


def displayed(node):
    """{topic: type} of all displays in a configuration of RViz."""
    found = {}
    if isinstance(node, dict):
        for key, value in node.items():
            if key in ("Topic", "Marker Topic", "Image Topic"):
                found[value] = TYPES[node["Class"]]
            found.update(displayed(value))
    elif isinstance(node, list):
        for item in node:
            found.update(displayed(item))
    return found


def topics_of(configuration):
    return displayed(yaml.safe_load((RVIZ / configuration).read_text())["Visualization Manager"])


class View(WholeRun):
    duration_s = "5"
    options = ["--rgb-scale", "0.125", "--cameras", "camera_left_front,camera_ir"]
    cameras_not_recorded = ("camera_left_side", "camera_right_front", "camera_right_side")

    def advertised(self, launched):
        """{topic: type} of everything that was published, also by nodes that have ended."""
        master = xmlrpc.client.ServerProxy(launched.environment["ROS_MASTER_URI"])
        return {topic: kind for topic, kind in master.getTopicTypes("/view_test")[2] if topic.startswith("/atlas/")}

    def replay(self, launched, *arguments):
        replay = launched.beside(["roslaunch", "atlas_bringup", "replay.launch", "rate:=1", *arguments])
        self.assertEqual(replay.wait(timeout=LIMIT_S), 0)

    def test_every_display_gets_its_topic_and_the_outputs_stay_the_same(self):
        import rosbag
        wanted, out, seen = topics_of("atlas.rviz"), self.fresh("watched"), self.folder / "seen.bag"
        self.assertGreater(len(wanted), 10)
        with self.launched("watched", "view.launch", ["rviz:=false"]) as launched:
            recorder = launched.beside(["rosbag", "record", "--buffsize=0", "-O", str(seen), *wanted])
            launched.wait_for("Subscribing to", times=len(wanted))
            self.replay(launched, f"bag:={self.bag}", f"out:={out}", "write_deskewed:=true")
            os.killpg(recorder.pid, signal.SIGINT)
            recorder.wait(timeout=30)
            advertised = self.advertised(launched)
        self.assertEqual({topic: advertised.get(topic) for topic in wanted}, wanted)
        self.check(out)
        recorded = {topic for topic in wanted if not any(f"/{camera}/" in topic for camera in self.cameras_not_recorded)}
        with rosbag.Bag(str(seen)) as bag:
            self.assertEqual(set(bag.get_type_and_topic_info().topics), recorded)
            for topic, array, _ in bag.read_messages([t for t in wanted if t.startswith("/atlas/markers/")]):
                self.assertEqual([i for i, m in enumerate(array.markers) if m.action == DELETE_ALL], [0], topic)
                self.assertEqual(len({m.header.stamp for m in array.markers}), 1, topic)
                self.assertGreater(array.markers[0].header.stamp.to_sec(), 1e9, topic)

    def test_every_display_of_a_kitti_drive_has_its_topic(self):
        drive = Path(os.environ.get("ATLAS_DATA") or "/nowhere", "kitti_raw_0052")
        if not drive.is_dir():
            raise unittest.SkipTest("ATLAS_DATA is not set")
        with self.launched("kitti", "view.launch", ["rviz:=false", "rig:=kitti"]) as launched:
            launched.wait_for("started core service")
            self.replay(launched, f"record:={drive}", "rig:=kitti")
            advertised = self.advertised(launched)
        wanted = topics_of("kitti.rviz")
        self.assertEqual({topic: advertised.get(topic) for topic in wanted}, wanted)

    def screenshot(self, *arguments):
        environment = {key: value for key, value in os.environ.items() if key != "DISPLAY"}
        environment["ATLAS_VIEW_TEST"] = str(os.getpid())
        return subprocess.run([RVIZ / "scripts/screenshot", *map(str, arguments)], env=environment, capture_output=True,
                              text=True, timeout=LIMIT_S, check=False)

    def left_behind(self):
        """Commands of the processes that came from a screenshot and are still there."""
        needle, found = f"ATLAS_VIEW_TEST={os.getpid()}".encode(), []
        for entry in Path("/proc").iterdir():
            try:
                if entry.name.isdigit() and needle in (entry / "environ").read_bytes().split(b"\0"):
                    found.append((entry / "cmdline").read_bytes())
            except OSError:
                continue
        return found

    def test_a_picture_without_a_display(self):
        picture = self.folder / "pictures/rviz.png"
        result = self.screenshot("--record", self.record, picture, "--seconds", "3")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        head = picture.read_bytes()[:24]
        self.assertEqual(head[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual([int.from_bytes(head[i:i + 4], "big") for i in (16, 20)], [1600, 900])
        self.assertEqual(self.left_behind(), [])

    def test_what_cannot_be_shown_is_named(self):
        for arguments, reason in ((["--record", self.folder / "missing", "a.png"], "no such record"),
                                  (["--bag", self.folder / "missing.bag", "a.png"], "no such bag")):
            result = self.screenshot(*arguments)
            self.assertEqual(result.returncode, 1)
            self.assertIn(reason, result.stderr)
            self.assertIn("missing", result.stderr)
        empty = self.fresh("empty_record")
        empty.mkdir()
        result = self.screenshot("--record", empty, self.folder / "empty.png")
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn("neither a Brno Urban Dataset record", result.stderr)
        self.assertFalse((self.folder / "empty.png").exists())
        self.assertEqual(self.left_behind(), [])


if __name__ == "__main__":
    run(View, "view", __doc__)
