#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How runs end: by themselves, by Ctrl-C, with a second recording after the first, with a stage that refuses its parameters,
with sensors that are not there. In each case the outputs are valid, the summary tells the truth and no process stays.

usage (inside the workspace's environment): endings_test.py --junit FILE [--keep DIR]
"""
import re
import subprocess
import time
from pathlib import Path

from whole_run import LIMIT_S, WholeRun, find_program, hashes, run


class Endings(WholeRun):
    duration_s = "5"
    options = ["--rgb-scale", "0.125", "--cameras", "camera_left_front,camera_ir"]

    def play(self, *extra):
        return ["rosbag", "play", "--clock", "-d", "2", "--queue", "10000", *extra, str(self.bag)]

    def events_of_runs(self, log):
        """Number of events of each complete run that the log tells of."""
        return [int(n) for n in re.findall(r"complete: (\d+) events", log.read_text(errors="replace"))]

    def test_interrupted_run_leaves_valid_files(self):
        out = self.fresh("interrupted")
        with self.launched("interrupted", "replay.launch", [f"bag:={self.bag}", f"out:={out}", "rate:=0.5"]) as launched:
            launched.wait_for("replay begins")
            time.sleep(4)
            launched.interrupt()
            launched.process.wait(timeout=30)
        summary = self.summary(out)
        self.assertFalse(summary["complete"])
        self.assertIn("interrupted", summary["failure"])
        lines = (out / "trajectory/trajectory.tum").read_text().splitlines()
        self.assertGreater(len(lines), 100)
        self.assertEqual([line for line in lines if len(line.split()) != 8], [])
        whole = (self.reference_out / "trajectory/trajectory.tum").read_text().splitlines()
        self.assertEqual(lines, whole[:len(lines)], "what was written is not the beginning of the whole run")
        self.assertEqual([name for name in hashes(out) if "tmp" in name or "partial" in name], [], "temporary files stay")

    def test_a_second_recording_after_the_first(self):
        out = self.fresh("twice")
        with self.launched("twice", "bringup.launch", [f"out:={out}", "write_deskewed:=true"]) as launched:
            for number in (1, 2):
                launched.wait_for("ready for")
                launched.beside(self.play())
                launched.wait_for("complete:", LIMIT_S, times=number)
                self.check(out)

    def test_a_recording_in_a_loop(self):
        with self.launched("loop", "bringup.launch", []) as launched:
            launched.wait_for("ready for")
            player = launched.beside(self.play("--loop", "--rate", "2"))
            launched.wait_for("complete:", LIMIT_S, times=2)
            self.assertIn("the stages begin afresh", launched.log.read_text(errors="replace"))
            player.terminate()
        events = self.events_of_runs(launched.log)
        self.assertGreaterEqual(len(events), 2)
        self.assertEqual(events[0], events[1])

    def test_a_refused_parameter_ends_the_run(self):
        config = self.folder / "wrong.yaml"
        text = self.config_text()
        self.assertIn("cluster_tolerance_m: 0.3", text)
        config.write_text(text.replace("cluster_tolerance_m: 0.3", "cluster_tolerance_m: -0.3"))
        with self.launched("refused", "replay.launch", [f"bag:={self.bag}", f"config:={config}"]) as launched:
            launched.process.wait(timeout=60)
        log = launched.log.read_text(errors="replace")
        self.assertIn("cluster_tolerance_m", log)
        self.assertIn("REQUIRED process [atlas/obstacles-", log)
        self.assertNotIn("exit code -", log)  # only that nodelet is refused, the manager does not crash
        self.assertIn("-0.3", log)

    def test_an_unknown_parameter_ends_the_run(self):
        config = self.folder / "unknown.yaml"
        config.write_text(self.config_text().replace("cluster_tolerance_m: 0.3", "cluster_color: 3\n  cluster_tolerance_m: 0.3"))
        with self.launched("unknown", "replay.launch", [f"bag:={self.bag}", f"config:={config}"]) as launched:
            launched.process.wait(timeout=60)
        self.assertIn("unknown parameter /atlas/obstacles/cluster_color", launched.log.read_text(errors="replace"))

    def config_text(self):
        return (Path(__file__).resolve().parents[2] / "atlas_bringup/config/bud.yaml").read_text()

    def test_a_missing_bag_is_named(self):
        with self.launched("missing", "replay.launch", ["bag:=/nowhere/at_all.bag"]) as launched:
            launched.process.wait(timeout=60)
        self.assertIn("/nowhere/at_all.bag", launched.log.read_text(errors="replace"))

    def test_pause_and_step(self):
        with self.launched("paused", "replay.launch", [f"bag:={self.bag}", "paused:=true"]) as launched:
            launched.wait_for("replay begins")
            step = ["rosservice", "call", "/atlas/player/step"]
            self.assertIn("success: True", launched.ask(step))
            time.sleep(2)
            self.assertEqual(self.events_of_runs(launched.log), [], "it ran although it was paused")
            self.assertIn("success: True", launched.ask(["rosservice", "call", "/atlas/player/pause", "false"]))
            launched.process.wait(timeout=LIMIT_S)
        self.assertEqual(len(self.events_of_runs(launched.log)), 1)

    def test_missing_sensors_do_not_stop_the_rest(self):
        bag, out = self.folder / "position.bag", self.fresh("position")
        topics = ["imu/data", "gnss/fix", "gnss/heading", "lidar_left/points"]
        subprocess.run([find_program("record_to_bag"), self.record, "-o", bag, "--force", "--topics", ",".join(topics)],
                       check=True, timeout=LIMIT_S)
        with self.launched("position", "replay.launch", [f"bag:={bag}", f"out:={out}", "write_deskewed:=true"]) as launched:
            launched.process.wait(timeout=LIMIT_S)
        self.assertTrue(self.summary(out)["complete"])
        found = hashes(out)
        same = [name for name in self.reference if name.startswith(("trajectory/", "deskewed/lidar_left/"))]
        self.assertGreater(len(same), 20)
        self.assertEqual([name for name in same if found.get(name) != self.reference[name]], [])
        self.assertEqual([name for name in found if "lidar_right" in name], [])


if __name__ == "__main__":
    run(Endings, "endings", __doc__)
