#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A node that knows only standard messages: it publishes IMU, GNSS and heading of a straight drive to the north-east and listens
to what comes back. The truth is a formula: 5 m/s from the first fix on."""
import math
import threading
import time
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu, NavSatFix
from tf2_msgs.msg import TFMessage

BEGIN_S, DURATION_S = 1000, 20
SPEED_MPS, YAW_RAD = 5.0, math.pi / 4
LATITUDE_DEG, LONGITUDE_DEG, ALTITUDE_M = 49.0, 16.5, 250.0
GNSS_SIGMA_M, HEADING_SIGMA_RAD = 0.02, 0.02
GRAVITY_MPS2 = 9.8095  # WGS84 at this latitude and height


def stamp(index, rate_hz):
    return rospy.Time(BEGIN_S) + rospy.Duration(nsecs=index * (10**9 // rate_hz))


def geodetic(east_m, north_m):
    """Small offsets on the WGS84 ellipsoid: radii of curvature at LATITUDE_DEG (NIMA TR8350.2)."""
    a, e2, sin2 = 6378137.0, 6.69437999014e-3, math.sin(math.radians(LATITUDE_DEG))**2
    prime_vertical = a / math.sqrt(1 - e2 * sin2)
    meridian = a * (1 - e2) / (1 - e2 * sin2)**1.5
    latitude = LATITUDE_DEG + math.degrees(north_m / (meridian + ALTITUDE_M))
    longitude = LONGITUDE_DEG + math.degrees(east_m / ((prime_vertical + ALTITUDE_M) * math.cos(math.radians(LATITUDE_DEG))))
    return latitude, longitude


class PositioningFromTopics(unittest.TestCase):
    def setUp(self):
        self.lock = threading.Lock()
        self.received = {"odometry": [], "tf": [], "geographic": [], "diagnostics": []}
        self.subscribers = [rospy.Subscriber(topic, kind, self.keep(name)) for topic, kind, name in (
            ("/atlas/odometry", Odometry, "odometry"), ("/tf", TFMessage, "tf"),
            ("/atlas/geographic", NavSatFix, "geographic"), ("/diagnostics", DiagnosticArray, "diagnostics"))]

    def keep(self, name):
        def callback(message):
            with self.lock:
                self.received[name].append(message)
        return callback

    def count(self, name):
        with self.lock:
            return len(self.received[name])

    def await_links(self, publishers):
        deadline = time.monotonic() + 60
        while any(p.get_num_connections() == 0 for p in publishers):
            self.assertLess(time.monotonic(), deadline, "nobody subscribes " + ", ".join(p.name for p in publishers))
            time.sleep(0.1)

    def test_straight_drive(self):
        imu = rospy.Publisher("/imu/data", Imu, queue_size=10000)
        fix = rospy.Publisher("/gnss/fix", NavSatFix, queue_size=10000)
        heading = rospy.Publisher("/gnss/heading", Imu, queue_size=10000)
        transforms = rospy.Publisher("/tf_static", TFMessage, queue_size=10, latch=True)
        clock = rospy.Publisher("/clock", Clock, queue_size=10)
        self.await_links([imu, fix, heading])
        transforms.publish(TFMessage([self.transform()]))
        for index in range(DURATION_S * 100):
            imu.publish(self.imu_message(index))
            if index % 10 == 0:
                fix.publish(self.fix_message(index // 10))
                heading.publish(self.heading_message(index // 10))
                clock.publish(Clock(stamp(index, 100)))
                time.sleep(0.005)
        for publisher in (imu, fix, heading, transforms):
            publisher.unregister()
        deadline = time.monotonic() + 40
        while self.count("odometry") < DURATION_S * 100 - 50 and time.monotonic() < deadline:
            time.sleep(0.2)
        self.judge()

    def transform(self):
        message = TransformStamped()
        message.header.stamp = rospy.Time(BEGIN_S)
        message.header.frame_id, message.child_frame_id = "base_link", "antenna"
        message.transform.translation.x = -1.0  # the antenna is a metre behind: the first fix is not where the vehicle is
        message.transform.rotation.w = 1.0
        return message

    def imu_message(self, index):
        message = Imu()
        message.header.stamp, message.header.frame_id = stamp(index, 100), "base_link"
        message.orientation.w = 1.0
        message.linear_acceleration.z = GRAVITY_MPS2
        return message

    def fix_message(self, index):
        message = NavSatFix()
        message.header.stamp, message.header.frame_id = stamp(index, 10), "antenna"
        along = SPEED_MPS * index / 10 - 1.0
        message.latitude, message.longitude = geodetic(along * math.cos(YAW_RAD), along * math.sin(YAW_RAD))
        message.altitude = ALTITUDE_M
        message.position_covariance = [GNSS_SIGMA_M**2, 0, 0, 0, GNSS_SIGMA_M**2, 0, 0, 0, GNSS_SIGMA_M**2]
        message.position_covariance_type = NavSatFix.COVARIANCE_TYPE_DIAGONAL_KNOWN
        return message

    def heading_message(self, index):
        message = Imu()
        message.header.stamp, message.header.frame_id = stamp(index, 10), "base_link"
        message.orientation.z, message.orientation.w = math.sin(YAW_RAD / 2), math.cos(YAW_RAD / 2)
        message.orientation_covariance = [1e6, 0, 0, 0, 1e6, 0, 0, 0, HEADING_SIGMA_RAD**2]
        message.angular_velocity_covariance[0] = message.linear_acceleration_covariance[0] = -1
        return message

    def judge(self):
        odometry = sorted(self.received["odometry"], key=lambda m: m.header.stamp)
        self.assertGreaterEqual(len(odometry), DURATION_S * 100 - 50, "odometry at IMU rate")
        anchor = self.received["geographic"][-1]
        self.assertAlmostEqual(anchor.altitude, ALTITUDE_M, delta=1e-3)
        last = odometry[-1]
        self.assertEqual((last.header.frame_id, last.child_frame_id), ("map", "base_link"))
        # map begins at the first fix, that is where the antenna was: the vehicle was one metre ahead of it
        along = SPEED_MPS * (last.header.stamp - rospy.Time(BEGIN_S)).to_sec() + 1.0
        expected = (along * math.cos(YAW_RAD), along * math.sin(YAW_RAD))
        p = last.pose.pose.position
        self.assertLess(math.hypot(p.x - expected[0], p.y - expected[1]), 4 * GNSS_SIGMA_M)
        self.assertAlmostEqual(last.twist.twist.linear.x, SPEED_MPS, delta=0.1)
        self.assertGreater(last.pose.covariance[0], 0.0)
        frames = {(t.header.frame_id, t.child_frame_id) for m in self.received["tf"] for t in m.transforms}
        self.assertIn(("map", "odom"), frames)
        self.assertIn(("odom", "base_link"), frames)
        names = {status.name for m in self.received["diagnostics"] for status in m.status}
        self.assertTrue(any("localization" in name for name in names), names)


if __name__ == "__main__":
    rospy.init_node("positioning_from_topics", disable_rostime=True)
    rostest.rosrun("atlas_tests", "positioning_from_topics", PositioningFromTopics)
