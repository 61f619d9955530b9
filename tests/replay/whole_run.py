# SPDX-License-Identifier: MIT
"""What the tests of whole runs share: a synthetic bag, launch files run to their end, hashes of outputs, processes left behind."""
import argparse
import hashlib
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree as xml
from pathlib import Path

LIMIT_S = 240


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


def free_port():
    """A port for a master, below the range that the system gives to connections."""
    for port in range(12000 + os.getpid() % 10000, 32000):
        with socket.socket() as probe:
            try:
                probe.bind(("127.0.0.1", port))
                return port
            except OSError:
                continue
    raise RuntimeError("no free port")


def hashes(out):
    """SHA-256 of every output file but run.json, which holds timings."""
    result = {}
    for path in sorted(out.rglob("*")):
        if path.is_file() and path.name != "run.json":
            result[str(path.relative_to(out))] = hashlib.sha256(path.read_bytes()).hexdigest()
    return result


def kill_after(process, patience_s):
    try:
        process.wait(timeout=patience_s)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()


class Launched:
    """A launch file that runs; leaves no process behind when the block ends."""

    def __init__(self, test, name, launch_file, arguments):
        self.test, self.port, self.log = test, free_port(), test.folder / (name + ".log")
        self.environment = environment(self.port, test.folder / "ros")
        self.output = open(self.log, "wb")
        self.children = []
        command = ["roslaunch", "-p", str(self.port), "atlas_bringup", launch_file] + arguments
        self.process = self.beside(command)

    def beside(self, command):
        """Starts a command with the same master, its output goes to the same log."""
        process = subprocess.Popen(command, env=self.environment, stdout=self.output, stderr=subprocess.STDOUT,
                                   stdin=subprocess.DEVNULL, start_new_session=True)
        self.children.append(process)
        return process

    def ask(self, command):
        """Output of a short command with the same master."""
        return subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=30, check=False).stdout

    def wait_for(self, text, patience_s=60, times=1):
        deadline = time.monotonic() + patience_s
        while self.log.read_bytes().count(text.encode()) < times:
            self.test.assertLess(time.monotonic(), deadline, f"'{text}' did not appear {times} times in {self.log}")
            self.test.assertIsNone(self.process.poll(), f"ended before '{text}' appeared in {self.log}")
            time.sleep(0.1)

    def interrupt(self):
        self.process.send_signal(signal.SIGINT)

    def __enter__(self):
        return self

    def __exit__(self, kind, value, trace):
        if self.process.poll() is None:  # roslaunch gives every node a session of its own and ends them only on SIGINT
            self.interrupt()
        for child in self.children:
            kill_after(child, 20 if child is self.process else 1)
        self.output.close()
        deadline = time.monotonic() + 10
        while processes_of(self.port) and time.monotonic() < deadline:
            time.sleep(0.2)
        if kind is None:
            self.test.assertEqual(processes_of(self.port), [], "processes left behind")


class WholeRun(unittest.TestCase):
    """setUpClass makes the bag and the reference outputs of the offline replay."""

    folder = None
    keep = None
    duration_s = "8"
    options = ["--rgb-scale", "0.25"]

    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.keep or tempfile.mkdtemp(prefix="atlas_runs_"))
        cls.folder.mkdir(parents=True, exist_ok=True)
        cls.record, cls.bag = cls.folder / "record", cls.folder / "drive.bag"
        if not cls.bag.exists():
            subprocess.run([find_program("make_drive"), cls.record, "--seed", "5", "--duration", cls.duration_s, *cls.options],
                           check=True, timeout=LIMIT_S)
            subprocess.run([find_program("record_to_bag"), cls.record, "-o", cls.bag], check=True, timeout=LIMIT_S)
        cls.reference_out = cls.folder / "offline"
        cls.replay_offline(["--bag", cls.bag], cls.reference_out)
        cls.reference = hashes(cls.reference_out)

    @classmethod
    def tearDownClass(cls):
        if not cls.keep:
            shutil.rmtree(cls.folder)

    @classmethod
    def replay_offline(cls, source, out):
        shutil.rmtree(out, ignore_errors=True)
        subprocess.run([find_program("atlas_replay"), *source, "--out", out, "--write", "deskewed"], check=True, timeout=LIMIT_S)

    def fresh(self, name):
        out = self.folder / name
        shutil.rmtree(out, ignore_errors=True)
        return out

    def launched(self, name, launch_file, arguments):
        return Launched(self, name, launch_file, arguments)

    def summary(self, out):
        return json.loads((out / "run.json").read_text())

    def check(self, out):
        """The run is complete, nothing came late, and every file is the reference's, bit by bit."""
        summary = self.summary(out)
        self.assertTrue(summary["complete"], summary.get("failure"))
        late = {f"{stage}: {name}": value for stage, counters in summary["stages"].items()
                for name, value in counters.items() if name.startswith("late") and value > 0}
        self.assertEqual(late, {})
        found = hashes(out)
        self.assertGreater(len(self.reference), 50)
        self.assertEqual(sorted(set(self.reference) ^ set(found)), [], "files that only one way wrote")
        self.assertEqual([name for name in self.reference if self.reference[name] != found[name]], [], "files that differ")


def write_junit(path, suite_name, result, names):
    bad = {str(test): text for test, text in result.failures + result.errors}
    skipped = {str(test): reason for test, reason in result.skipped}
    suite = xml.Element("testsuite", name=suite_name, tests=str(len(names)), failures=str(len(bad)), errors="0")
    for name in names:
        case = xml.SubElement(suite, "testcase", classname=suite_name, name=name.split()[0])
        if name in bad:
            xml.SubElement(case, "failure", message="failed").text = bad.pop(name)
        elif name in skipped:
            xml.SubElement(case, "skipped", message=skipped[name])
    for name, text in bad.items():  # setUpClass
        case = xml.SubElement(suite, "testcase", classname=suite_name, name=name)
        xml.SubElement(case, "failure", message="failed").text = text
    xml.ElementTree(suite).write(path)


def run(test_class, suite_name, document):
    parser = argparse.ArgumentParser(description=document)
    parser.add_argument("--junit", required=True)
    parser.add_argument("--keep", help="folder that stays, with bag, outputs and logs")
    parser.add_argument("--only", help="one test by its name")
    arguments = parser.parse_args()
    WholeRun.keep = arguments.keep
    loader = unittest.TestLoader()
    suite = (loader.loadTestsFromName(arguments.only, test_class) if arguments.only
             else loader.loadTestsFromTestCase(test_class))
    names = [str(test) for test in suite]
    result = unittest.TextTestRunner(verbosity=2).run(suite)
    write_junit(arguments.junit, suite_name, result, names)
    sys.exit(0 if result.wasSuccessful() else 1)
