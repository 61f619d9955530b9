#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""One synthetic bag through every way to run the suite: the same SHA-256 of every output file, nothing late, nothing dropped,
no process left behind.

usage (inside the workspace's environment): determinism_test.py --junit FILE [--keep DIR]
"""
import subprocess
import sys

from whole_run import LIMIT_S, WholeRun, find_program, hashes, run


class Determinism(WholeRun):
    """Every test is one way to run."""

    def launch(self, name, launch_file, arguments, beside=None, busy=0):
        """Runs a launch file to its own end, optionally with a second command and busy cores beside it; gives its outputs."""
        out = self.fresh(name)
        loops = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(busy)]
        try:
            with self.launched(name, launch_file, [f"out:={out}", "write_deskewed:=true", *arguments]) as launched:
                if beside:
                    launched.wait_for("ready for")
                    launched.beside(beside)
                launched.process.wait(timeout=LIMIT_S)
        finally:
            for loop in loops:
                loop.kill()
                loop.wait()
        return out

    def test_a_offline_twice(self):
        self.replay_offline(["--bag", self.bag], self.folder / "offline_again")
        self.check(self.folder / "offline_again")

    def test_a_offline_in_one_thread(self):
        self.replay_offline(["--bag", self.bag, "--one-thread"], self.folder / "offline_one_thread")
        self.check(self.folder / "offline_one_thread")

    def test_a_offline_from_the_record(self):
        self.replay_offline(["--record", self.record], self.folder / "offline_record")
        self.check(self.folder / "offline_record")

    def test_a_smoothed_in_two_passes(self):
        """From the bag, again, and from the record; without pictures, which do not depend on the second pass being one."""
        found = []
        light = self.folder / "position.bag"
        topics = "imu/data,gnss/fix,gnss/heading,lidar_left/points"
        subprocess.run([find_program("record_to_bag"), self.record, "-o", light, "--force", "--topics", topics], check=True,
                       timeout=LIMIT_S)
        for name, source in (("first", ["--bag", light]), ("again", ["--bag", light]), ("record", ["--record", self.record])):
            out = self.folder / ("smoothed_" + name)
            self.replay_offline([*source, "--smooth"], out)
            self.assertTrue(self.summary(out)["complete"])
            found.append(hashes(out))
        self.assertEqual(found[0], found[1])
        same = [name for name in found[0] if name.startswith(("trajectory/", "deskewed/lidar_left/"))]
        self.assertIn("trajectory/smoothed.tum", same)
        self.assertGreater(len(same), 20)
        self.assertEqual([name for name in same if found[2][name] != found[0][name]], [], "bag and record differ")
        for name in ("trajectory/trajectory.tum", same[-1]):
            self.assertNotEqual(found[0][name], self.reference[name], name + " is the filter's, not the smoother's")

    def test_b_nodelets_as_fast_as_they_go(self):
        self.check(self.launch("rate_0", "replay.launch", [f"bag:={self.bag}", "rate:=0"]))

    def test_b_nodelets_with_one_thread(self):
        self.check(self.launch("one_thread", "replay.launch", [f"bag:={self.bag}", "rate:=0", "threads:=1"]))

    def test_c_nodelets_in_real_time_on_busy_cores(self):
        self.check(self.launch("rate_1", "replay.launch", [f"bag:={self.bag}", "rate:=1"], busy=2))

    def test_d_every_stage_in_its_own_process(self):
        self.check(self.launch("separate", "replay.launch", [f"bag:={self.bag}", "rate:=0", "separate:=true"]))

    def test_e_rosbag_play(self):
        self.check(self.launch("rosbag_play", "bringup.launch", ["exit_at_end:=true"],
                               beside=["rosbag", "play", "--clock", "-d", "3", "--queue", "10000", str(self.bag)]))


if __name__ == "__main__":
    run(Determinism, "determinism", __doc__)
