# SPDX-License-Identifier: MIT
"""What screenshot and watch share: a ROS master of their own, view.launch and replay.launch on it, and an end that leaves nothing
behind."""
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import xmlrpc.client
from pathlib import Path

KITTI_FOLDERS = ("oxts", "velodyne_points", "image_02")
CLOUD_TOPIC = "/atlas/cloud"  # a topic that every configuration of RViz shows
COLOR = re.compile(r"\x1b(\[[0-9;]*m|\]2;)")  # escapes of the terminal
MARK = "ATLAS_DRIVE_VIEW"     # environment variable of all processes of a session


class Failed(Exception):
    """Ends the program with this text."""


def check_input(kind, path):
    """Absolute path of the drive."""
    path = Path(path).resolve()
    if kind == "record" and not path.is_dir():
        raise Failed(f"no such record: {path}")
    if kind == "bag" and not path.is_file():
        raise Failed(f"no such bag: {path}")
    if not os.environ.get("ROS_PACKAGE_PATH"):
        raise Failed("not inside the workspace's environment; use: ./atlas run rviz/scripts/...")
    return path


def rig_of(kind, path):
    """Which configuration a drive needs: "kitti" or "bud"."""
    if kind == "record":
        folders = [path] + [p for p in path.iterdir() if p.is_dir()]
        return "kitti" if any((folder / name).is_dir() for folder in folders for name in KITTI_FOLDERS) else "bud"
    import rosbag  # only here: a record needs no rosbag
    with rosbag.Bag(str(path)) as bag:
        topics = bag.get_type_and_topic_info().topics
    return "kitti" if any(topic.strip("/") == "velodyne/points" for topic in topics) else "bud"


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


class Session:
    """Context: the processes of one view. All of them end with it."""

    def __init__(self, verbose=False):
        self.folder = Path(tempfile.mkdtemp(prefix="atlas_view_"))
        self.port = free_port()
        self.verbose = verbose
        self.mark = f"{os.getpid()}-{self.port}"
        self.environment = dict(os.environ)
        self.environment.pop("ROS_HOSTNAME", None)
        self.environment.update({
            "ROS_MASTER_URI": f"http://127.0.0.1:{self.port}", "ROS_IP": "127.0.0.1", MARK: self.mark,
            "ROS_HOME": str(self.folder / "ros"), "ROS_LOG_DIR": str(self.folder / "ros/log"),
            "ROSCONSOLE_STDOUT_LINE_BUFFERED": "1"})  # or the last lines are missing in a log
        self.processes = []

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        if kind is not None and not self.verbose:
            self.print_logs()
        self.end()
        shutil.rmtree(self.folder, ignore_errors=True)

    def start(self, name, command, **options):
        """A process in a session of its own; what it prints goes to the terminal (verbose) or to a log that failures show."""
        output = None if self.verbose else open(self.folder / f"{name}.log", "wb")
        process = subprocess.Popen(command, env=self.environment, stdin=subprocess.DEVNULL, stdout=output,
                                   stderr=None if self.verbose else subprocess.STDOUT, start_new_session=True, **options)
        if output:
            output.close()
        self.processes.append(process)
        return process

    def start_view(self, rig):
        """RViz and the markers, with the master."""
        return self.start("view", ["roslaunch", "-p", str(self.port), "atlas_bringup", "view.launch", f"rig:={rig}"])

    def start_replay(self, kind, path, rig, arguments):
        return self.start("replay", ["roslaunch", "atlas_bringup", "replay.launch", f"{kind}:={path}", f"rig:={rig}", *arguments])

    def await_rviz(self, view, limit_s):
        """Returns when RViz has subscribed, so that nothing of the drive is missed."""
        deadline = time.monotonic() + limit_s
        while time.monotonic() < deadline:
            if view.poll() is not None:
                raise Failed("RViz did not start")
            try:
                subscribers = xmlrpc.client.ServerProxy(self.environment["ROS_MASTER_URI"]).getSystemState("/view")[2][1]
                if any(topic == CLOUD_TOPIC and any("rviz" in node for node in nodes) for topic, nodes in subscribers):
                    return
            except (OSError, xmlrpc.client.Error):
                pass  # the master is not there yet
            time.sleep(0.2)
        raise Failed(f"RViz did not subscribe within {limit_s:.0f} s")

    def end(self, patience_s=8.0):
        """Interrupts the processes, the screen after all others, waits, and kills what is still there."""
        deadline = time.monotonic() + patience_s
        screens = [p for p in self.processes if p.args[0] == "Xvfb"]
        for group in ([p for p in self.processes if p not in screens], screens):
            for process in group:
                if process.poll() is None:
                    process.send_signal(signal.SIGINT)  # roslaunch ends its nodes, which have groups of their own
            while time.monotonic() < deadline and any(p.poll() is None for p in group):
                time.sleep(0.1)
        while time.monotonic() < deadline and self.survivors():
            time.sleep(0.1)
        for pid in self.survivors():
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        for process in self.processes:
            process.wait()

    def survivors(self):
        """Process ids of this session, grandchildren too: they carry its mark in their environment."""
        found = []
        needle = f"{MARK}={self.mark}".encode()
        for entry in Path("/proc").iterdir():
            try:
                if entry.name.isdigit() and needle in (entry / "environ").read_bytes().split(b"\0"):
                    found.append(int(entry.name))
            except OSError:
                continue  # gone, or of another user
        return found

    def log(self, name):
        """What a process has printed so far; nothing when it prints to the terminal."""
        log = self.folder / f"{name}.log"
        return log.read_text(errors="replace") if log.exists() else ""

    def print_logs(self, lines=10):
        """Errors, and the last lines, of every process."""
        for log in sorted(self.folder.glob("*.log")):
            text = COLOR.sub("", self.log(log.stem)).splitlines()
            errors = [line for line in text[:-lines] if "FATAL" in line or "ERROR" in line]
            print("\n".join([f"--- {log.stem}", *errors, *text[-lines:]]), file=sys.stderr)
