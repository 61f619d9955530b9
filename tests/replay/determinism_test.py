#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""One synthetic bag through every way to run the suite: the same SHA-256 of every output file, nothing late, nothing dropped,
no process left behind.

usage (inside the workspace's environment): determinism_test.py --junit FILE [--keep DIR]
"""
import argparse
import hashlib
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

LIMIT_S = 90
DURATION_S = "8"


def find_program(name):
    for prefix in os.environ["CMAKE_PREFIX_PATH"].split(":"):
        for path in Path(prefix, "lib").glob("*/" + name):
            return str(path)
    raise FileNotFoundError(name)


def environment(port, ros_home):
    result = dict(os.environ)
    # without it rosconsole keeps its lines until the process ends when stdout is a file
    result.update(ROSCONSOLE_STDOUT_LINE_BUFFERED="1")
    result.update(ROS_MASTER_URI=f"http://127.0.0.1:{port}", ROS_IP="127.0.0.1", ROS_HOME=str(ros_home), ROS_LOG_DIR=str(ros_home / "log"))
    return result


def processes_of(port):
    """Commands of the processes whose environment names this master."""
    found = []
    for entry in Path("/proc").iterdir():
        if not entry.name.isdigit() or int(entry.name) == os.getpid():
            continue
        try:
            variables = (entry / "environ").read_bytes().split(b"\0")
            if f"ROS_MASTER_URI=http://127.0.0.1:{port}".encode() in variables:
                found.append((entry / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace"))
        except OSError:
            continue
    return found


def hashes(out):
    """SHA-256 of every output file but run.json, which holds timings."""
    result = {}
    for path in sorted(out.rglob("*")):
        if path.is_file() and path.name != "run.json":
            result[str(path.relative_to(out))] = hashlib.sha256(path.read_bytes()).hexdigest()
    return result


class Run(unittest.TestCase):
    """setUpClass makes the bag and the reference; every test is one way to run."""

    folder = None
    keep = None

    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.keep or tempfile.mkdtemp(prefix="atlas_determinism_"))
        cls.folder.mkdir(parents=True, exist_ok=True)
        cls.record, cls.bag = cls.folder / "record", cls.folder / "drive.bag"
        cls.port = 20000 + os.getpid() % 20000
        if not cls.bag.exists():
            subprocess.run([find_program("make_drive"), cls.record, "--seed", "5", "--duration", DURATION_S, "--rgb-scale", "0.25"],
                           check=True, timeout=LIMIT_S)
            subprocess.run([find_program("record_to_bag"), cls.record, "-o", cls.bag], check=True, timeout=LIMIT_S)
        cls.reference_out = cls.folder / "offline"
        subprocess.run([find_program("atlas_replay"), "--bag", cls.bag, "--out", cls.reference_out, "--write", "deskewed"],
                       check=True, timeout=LIMIT_S)
        cls.reference = hashes(cls.reference_out)

    @classmethod
    def tearDownClass(cls):
        if not cls.keep:
            shutil.rmtree(cls.folder)

    def launch(self, name, launch_file, arguments, beside=None, busy=0):
        """Runs a launch file to its own end, optionally with a second command and busy cores beside it; gives its outputs."""
        Run.port += 1
        out = self.folder / name
        shutil.rmtree(out, ignore_errors=True)
        env = environment(self.port, self.folder / "ros")
        log = open(self.folder / (name + ".log"), "wb")
        loops = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(busy)]
        command = ["roslaunch", "-p", str(self.port), "atlas_bringup", launch_file, f"out:={out}", "write_deskewed:=true"] + arguments
        process = subprocess.Popen(command, env=env, stdout=log, stderr=subprocess.STDOUT, start_new_session=True)
        helper = None
        try:
            if beside:
                self.wait_for(self.folder / (name + ".log"), b"ready for")
                helper = subprocess.Popen(beside, env=env, stdout=log, stderr=subprocess.STDOUT, start_new_session=True)
            process.wait(timeout=LIMIT_S)
        finally:
            for loop in loops:
                loop.kill()
            if process.poll() is None:  # roslaunch gives every node a session of its own and ends them only on SIGINT
                process.send_signal(signal.SIGINT)
                self.kill_after(process, 20)
            if helper:
                self.kill_after(helper, 1)
        deadline = time.monotonic() + 10
        while processes_of(self.port) and time.monotonic() < deadline:
            time.sleep(0.2)
        self.assertEqual(processes_of(self.port), [], "processes left behind")
        return out

    def kill_after(self, process, patience_s):
        try:
            process.wait(timeout=patience_s)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)

    def wait_for(self, log, text):
        deadline = time.monotonic() + 60
        while text not in log.read_bytes():
            self.assertLess(time.monotonic(), deadline, f"'{text.decode()}' did not appear in {log}")
            time.sleep(0.2)

    def check(self, out):
        summary = json.loads((out / "run.json").read_text())
        self.assertTrue(summary["complete"], summary.get("failure"))
        late = {f"{stage}: {name}": value for stage, counters in summary["stages"].items()
                for name, value in counters.items() if name.startswith("late") and value > 0}
        self.assertEqual(late, {})
        found = hashes(out)
        self.assertGreater(len(self.reference), 100)
        self.assertEqual(sorted(set(self.reference) ^ set(found)), [], "files that only one way wrote")
        self.assertEqual([name for name in self.reference if self.reference[name] != found[name]], [], "files that differ")

    def test_a_offline_twice(self):
        out = self.folder / "offline_again"
        subprocess.run([find_program("atlas_replay"), "--bag", self.bag, "--out", out, "--write", "deskewed"], check=True, timeout=LIMIT_S)
        self.check(out)

    def test_a_offline_from_the_record(self):
        out = self.folder / "offline_record"
        subprocess.run([find_program("atlas_replay"), "--record", self.record, "--out", out, "--write", "deskewed"], check=True, timeout=LIMIT_S)
        self.check(out)

    def test_b_nodelets_as_fast_as_they_go(self):
        self.check(self.launch("rate_0", "replay.launch", [f"bag:={self.bag}", "rate:=0"]))

    def test_c_nodelets_in_real_time_on_busy_cores(self):
        self.check(self.launch("rate_1", "replay.launch", [f"bag:={self.bag}", "rate:=1"], busy=2))

    def test_d_every_stage_in_its_own_process(self):
        self.check(self.launch("separate", "replay.launch", [f"bag:={self.bag}", "rate:=0", "separate:=true"]))

    def test_e_rosbag_play(self):
        self.check(self.launch("rosbag_play", "bringup.launch", ["exit_at_end:=true"],
                               beside=["rosbag", "play", "--clock", "-d", "3", "--queue", "10000", str(self.bag)]))


def write_junit(path, result, names):
    import xml.etree.ElementTree as xml
    bad = {str(test): text for test, text in result.failures + result.errors}
    suite = xml.Element("testsuite", name="determinism", tests=str(len(names)), failures=str(len(bad)), errors="0")
    for name in names:
        case = xml.SubElement(suite, "testcase", classname="determinism", name=name.split()[0])
        if name in bad:
            xml.SubElement(case, "failure", message="failed").text = bad.pop(name)
    for name, text in bad.items():  # setUpClass
        case = xml.SubElement(suite, "testcase", classname="determinism", name=name)
        xml.SubElement(case, "failure", message="failed").text = text
    xml.ElementTree(suite).write(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--junit", required=True)
    parser.add_argument("--keep", help="folder that stays, with bag, outputs and logs")
    parser.add_argument("--only", help="one test by its name")
    arguments = parser.parse_args()
    Run.keep = arguments.keep
    loader = unittest.TestLoader()
    suite = loader.loadTestsFromName(arguments.only, Run) if arguments.only else loader.loadTestsFromTestCase(Run)
    names = [str(test) for test in suite]
    result = unittest.TextTestRunner(verbosity=2).run(suite)
    write_junit(arguments.junit, result, names)
    return 0 if result.wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main())
