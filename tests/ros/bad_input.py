#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The localization nodelet and input that is not as it should be: the drive of positioning_from_topics with samples and fixes
spoilt on purpose. Each must be counted under its reason in the diagnostics and in what the stage reports at the end of the run,
the position must stay where it is, and accelerations in g must end the run in words."""
import math
import os
import random
import sys
import time

import rospy
import rostest
from atlas_msgs.msg import ImuBias, LocalizationStatus, StageProgress
from diagnostic_msgs.msg import DiagnosticStatus
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu, NavSatFix
from tf2_msgs.msg import TFMessage

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import positioning_from_topics as drive

BAD_FIX = {40: "zero", 50: "nowhere", 60: "outlier", 65: "jump", 70: "duplicate"}  # by the index of the fix, 10 a second
SATURATED, REBOUND = range(1000, 1004), range(1004, 1008)  # of the IMU, 100 a second: a blow that ends at the range limit
RANGE_MPS2 = 39.2
METRES_PER_DEG = 111.2e3
GAP = range(1200, 1230)
LATE = 1400  # this sample comes after the next one

EXPECTED = {
    "fix covariance unusable, parameter taken": 1,
    "skipped fix: latitude and longitude exactly 0": 1,
    "skipped fix: outlier": 1,
    "skipped fix: jumped away from the second receiver and the prediction": 1,
    "skipped fix: same stamp": 1,
    "skipped imu: accelerometer saturated": 2,  # the third and the fourth: two alike may be chance
    "imu gaps": 1,
    "skipped second fix: the first receiver is in use": 200,
}


class BadInput(drive.PositioningFromTopics):
    test_straight_drive = None  # that one has its own launch file

    def setUp(self):
        super().setUp()
        self.received.update({"progress": [], "status": [], "bias": [], "fused": []})
        self.subscribers += [rospy.Subscriber(topic, kind, self.keep(name)) for topic, kind, name in (
            ("/atlas/progress", StageProgress, "progress"), ("/atlas/localization_status", LocalizationStatus, "status"),
            ("/atlas/imu_bias", ImuBias, "bias"), ("/atlas/fused_fix", NavSatFix, "fused"))]

    def tearDown(self):
        for subscriber in self.subscribers:
            subscriber.unregister()

    def play(self, seconds, imu_message):
        imu = rospy.Publisher("/imu/data", Imu, queue_size=10000)
        fix = rospy.Publisher("/gnss/fix", NavSatFix, queue_size=10000)
        second = rospy.Publisher("/imu/gnss/fix", NavSatFix, queue_size=10000)
        heading = rospy.Publisher("/gnss/heading", Imu, queue_size=10000)
        transforms = rospy.Publisher("/tf_static", TFMessage, queue_size=10, latch=True)
        clock = rospy.Publisher("/clock", Clock, queue_size=10)
        self.await_links([imu, fix, second, heading])
        transforms.publish(TFMessage([self.transform()]))
        for index in range(seconds * 100):
            for message in imu_message(index):
                imu.publish(message)
            if index % 10 == 0:
                for message in self.fixes(index // 10):
                    fix.publish(message)
                second.publish(self.second_fix(index // 10))
                heading.publish(self.heading_message(index // 10))
                clock.publish(Clock(drive.stamp(index, 100)))
                time.sleep(0.005)
        time.sleep(0.5)
        for publisher in (imu, fix, second, heading, transforms):
            publisher.unregister()

    def await_end(self):
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline:
            with self.lock:
                for message in self.received["progress"]:
                    if message.stage == "localization" and (message.finished or message.failed):
                        return message
            time.sleep(0.1)
        self.fail("the run of the localization did not end")

    def fixes(self, index):
        message = self.fix_message(index)
        noise = random.Random(index)  # fixes as good as they say, not better
        message.latitude += noise.gauss(0, drive.GNSS_SIGMA_M) / METRES_PER_DEG
        message.longitude += noise.gauss(0, drive.GNSS_SIGMA_M) / METRES_PER_DEG / math.cos(math.radians(drive.LATITUDE_DEG))
        message.altitude += noise.gauss(0, drive.GNSS_SIGMA_M)
        kind = BAD_FIX.get(index)
        if kind == "zero":
            message.position_covariance = [0.0] * 9
        elif kind == "nowhere":
            message.latitude = message.longitude = 0.0
        elif kind == "outlier":
            message.latitude += 0.0001  # 11 m: the second receiver, 3 m, does not contradict that
        elif kind == "jump":
            message.latitude += 0.001
        return [message, message] if kind == "duplicate" else [message]

    def second_fix(self, index):
        message = self.fix_message(index)
        message.header.frame_id = "base_link"
        message.altitude = 0.0
        message.latitude += 1e-9 * index
        message.position_covariance_type = NavSatFix.COVARIANCE_TYPE_UNKNOWN
        return message

    def spoilt(self, index):
        if index in GAP or index == LATE:
            return []
        message = self.imu_message(index)
        message.angular_velocity.x = 1e-3 * math.sin(index)  # a signal that varies, as real ones do
        if index in SATURATED:
            message.linear_acceleration.z = RANGE_MPS2
        if index in REBOUND:
            message.linear_acceleration.z = 2 * drive.GRAVITY_MPS2 - RANGE_MPS2
        return [message]

    def in_g(self, index):
        message = self.imu_message(index)
        message.linear_acceleration.z /= drive.GRAVITY_MPS2
        return [message]

    def diagnostics(self):
        """Newest status of the stage: level, text, values."""
        with self.lock:
            found = [s for m in self.received["diagnostics"] for s in m.status if "localization" in s.name]
        self.assertTrue(found, "no diagnostics of the localization")
        return found[-1].level, found[-1].message, {v.key: v.value for v in found[-1].values}

    def test_1_counted_and_not_followed(self):
        self.play(drive.DURATION_S, self.spoilt)
        end = self.await_end()
        counters = dict(zip(end.counter_names, end.counter_values))
        self.assertTrue(end.finished, end.error)
        for name, count in EXPECTED.items():
            self.assertEqual(counters.get(name), count, name)
        time.sleep(1.0)
        _, _, values = self.diagnostics()
        for name, count in EXPECTED.items():
            self.assertEqual(values.get(name), str(count), name)
        self.judge_outputs()

    def judge_outputs(self):
        with self.lock:
            odometry = sorted(self.received["odometry"], key=lambda m: m.header.stamp)
            statuses, biases, fused = self.received["status"], self.received["bias"], self.received["fused"]
        for m in odometry[500:]:
            along = drive.SPEED_MPS * (m.header.stamp - rospy.Time(drive.BEGIN_S)).to_sec() + 1.0
            east, north = along * math.cos(drive.YAW_RAD), along * math.sin(drive.YAW_RAD)
            error = math.hypot(m.pose.pose.position.x - east, m.pose.pose.position.y - north)
            # 0.3 s without an IMU at 1.5 m/s^2 of unknown acceleration: 7 cm; GNSS takes it back
            self.assertLess(error, 0.15, m.header.stamp)
        self.assertGreaterEqual(len(statuses), drive.DURATION_S - 1, "a status a second")
        last = statuses[-1]
        self.assertEqual((last.state, last.receiver, last.jumps), (LocalizationStatus.RUNNING, "gnss/fix", 0))
        of_fixes = [s for s in last.innovations if s.source == "fix"][0]
        self.assertEqual((of_fixes.dof, of_fixes.rejected, of_fixes.count), (3, 1, of_fixes.used + 1))
        self.assertGreater(of_fixes.mean_nis, 0.0)
        self.assertTrue(all(b.gyro_sigma.x > 0 and b.accel_sigma.z > 0 for b in biases) and biases)
        self.assertEqual(len(fused), len(odometry))
        latitude, longitude = drive.geodetic(odometry[-1].pose.pose.position.x, odometry[-1].pose.pose.position.y)
        anchor = self.received["geographic"][-1]
        # the formula gives offsets from its own origin; the anchor is the first fix
        newest = max(fused, key=lambda m: m.header.stamp)
        self.assertAlmostEqual(newest.latitude - anchor.latitude, latitude - drive.LATITUDE_DEG, delta=2e-8)
        self.assertAlmostEqual(newest.longitude - anchor.longitude, longitude - drive.LONGITUDE_DEG, delta=2e-8)
        self.assertAlmostEqual(newest.position_covariance[0], odometry[-1].pose.covariance[0], delta=1e-12)
        self.assertEqual(newest.header.frame_id, "base_link")

    def test_2_accelerations_in_g_end_the_run(self):
        with self.lock:
            self.received["progress"].clear()
        self.play(5, self.in_g)
        end = self.await_end()
        self.assertTrue(end.failed)
        self.assertIn("in g; m/s^2 is needed", end.error)
        time.sleep(1.0)
        level, text, _ = self.diagnostics()
        self.assertEqual(level, DiagnosticStatus.ERROR)
        self.assertIn("in g; m/s^2 is needed", text)


if __name__ == "__main__":
    rospy.init_node("bad_input", disable_rostime=True)
    rostest.rosrun("atlas_tests", "bad_input", BadInput)
