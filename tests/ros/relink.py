#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""roscpp does not try again when the first request of a connection is lost. Both halves of the remedy: the source names the links
that are missing after some seconds, and a stage whose link is named subscribes anew."""
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

import rosbag
import roslib.packages
import rospy
import rostest
from atlas_msgs.msg import GraphStart, HelloRequest, StageHello, StageProgress
from sensor_msgs.msg import Imu

LIMIT_S = 60
END_OF_TIME = 2**63 - 1


def nodelet(name, kind):
    program = roslib.packages.find_node("nodelet", "nodelet")[0]
    return subprocess.Popen([program, "standalone", kind, f"__name:={name}", "__ns:=/atlas"])


class Relink(unittest.TestCase):
    def setUp(self):
        self.children = []

    def tearDown(self):
        for child in self.children:
            child.terminate()
            child.wait(timeout=LIMIT_S)

    def await_that(self, condition, what):
        deadline = time.monotonic() + LIMIT_S
        while not condition():
            self.assertLess(time.monotonic(), deadline, what)
            time.sleep(0.05)

    def test_source_asks_for_the_missing_link(self):
        """A stage that says it wants `imu/data` but has no connection: it subscribes when it is asked to."""
        folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, folder)
        with rosbag.Bag(str(folder / "a.bag"), "w") as bag:
            for i in range(100):
                message = Imu()
                message.header.stamp = rospy.Time(1000 + i // 10, i % 10 * 10**8)
                message.header.frame_id = "imu"
                message.linear_acceleration.z = 9.81
                bag.write("/imu/data", message, message.header.stamp)
        hello = rospy.Publisher("/atlas/hello", StageHello, queue_size=100)
        progress = rospy.Publisher("/atlas/progress", StageProgress, queue_size=100)
        state = {"asked": threading.Event(), "started": threading.Event(), "received": 0, "ended": threading.Event()}
        wanted = f"/atlas/imu/data {rospy.get_name()}"

        def on_imu(_):
            state["received"] += 1

        def on_request(request):
            if wanted in request.relink:
                state["asked"].set()
            elif state["asked"].is_set() and "imu" not in state:
                state["imu"] = rospy.Subscriber("/atlas/imu/data", Imu, on_imu)
            hello.publish(StageHello(stage="deaf", process=rospy.get_name(), inputs=["/atlas/imu/data"]))

        def on_progress(message):
            if message.stage == "source" and message.finished:
                progress.publish(StageProgress(stage="deaf", watermark_ns=END_OF_TIME, finished=True))

        listeners = [rospy.Subscriber("/atlas/hello_request", HelloRequest, on_request),
                     rospy.Subscriber("/atlas/progress", StageProgress, on_progress),
                     rospy.Subscriber("/atlas/graph_start", GraphStart, lambda _: state["started"].set())]
        rospy.set_param("/atlas/player", {"bag": str(folder / "a.bag"), "stages": ["deaf"], "lead_s": 100.0})
        player = nodelet("player", "atlas_loader/Player")
        self.children.append(player)
        self.assertTrue(state["asked"].wait(LIMIT_S), "the source did not name the link")
        self.assertFalse(state["started"].is_set(), "the run began without the link")
        self.assertTrue(state["started"].wait(LIMIT_S), "the run did not begin")
        self.assertEqual(player.wait(timeout=LIMIT_S), 0)
        self.assertEqual(state["received"], 100)
        for listener in [*listeners, state["imu"]]:
            listener.unregister()

    def test_stage_subscribes_anew(self):
        imu = rospy.Publisher("/atlas/imu/data", Imu, queue_size=10)
        request = rospy.Publisher("/atlas/hello_request", HelloRequest, queue_size=10)
        self.children.append(nodelet("localization", "atlas_localization/Localization"))
        self.await_that(lambda: imu.get_num_connections() == 1 and request.get_num_connections() == 1, "the stage did not subscribe")
        request.publish(HelloRequest(relink=["/atlas/imu/data /atlas/localization"]))
        self.await_that(lambda: imu.get_num_connections() == 0, "the stage did not let go")
        request.publish(HelloRequest(relink=["/atlas/imu/data /atlas/another"]))
        self.await_that(lambda: imu.get_num_connections() == 1, "the stage did not subscribe again")


if __name__ == "__main__":
    rospy.init_node("relink", disable_rostime=True)
    rostest.rosrun("atlas_tests", "relink", Relink, sys.argv)
