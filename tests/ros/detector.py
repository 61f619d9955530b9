#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The detector nodelet behind the player and the video decoder, with a model that finds red and blue squares: each image gets one
message, at its stamp, in order; an image without squares and one that cannot be read get an empty one; a model that is none
refuses the nodelet in words."""
import shutil
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path

import roslib.packages
import rosbag
import rospy
import rostest
from atlas_msgs.msg import Detection2dArray
from sensor_msgs.msg import Image

LIMIT_S = 60
CAMERA = "camera_left_front"
IMAGES, WIDTH, HEIGHT, SQUARE = 20, 64, 32, 16
NOTHING, UNREADABLE = 7, 11  # indices of the image without squares, and of the one that is shorter than it says
MODEL_PX = 32  # side of the model's input: the image is halved, which the squares of 16 px stand


def image(index):
    message = Image()
    message.header.stamp, message.header.frame_id = rospy.Time(1000, index * 10**8 % 10**9) + rospy.Duration(index // 10), CAMERA
    message.width, message.height, message.encoding, message.step = WIDTH, HEIGHT, "bgr8", WIDTH * 3
    pixels = bytearray(WIDTH * HEIGHT * 3)
    if index != NOTHING:
        for row in range(SQUARE):
            for column in range(SQUARE):
                pixels[row * message.step + (2 * SQUARE + column) * 3 + 2] = 255  # red, at (32, 0)
                pixels[(SQUARE + row) * message.step + column * 3] = 204  # blue, at (0, 16)
    message.data = bytes(pixels[:100]) if index == UNREADABLE else bytes(pixels)
    return message


class Detector(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.children = []
        self.addCleanup(self.end_children)

    def end_children(self):
        for child in self.children:
            if child.poll() is None:
                child.terminate()
            child.communicate(timeout=LIMIT_S)

    def nodelet(self, name, kind):
        program = roslib.packages.find_node("nodelet", "nodelet")[0]
        child = subprocess.Popen([program, "standalone", kind, f"__name:={name}", "__ns:=/atlas"], text=True,
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.children.append(child)
        return child

    def parameters(self, model):
        rospy.set_param("/atlas/detector", {"model": str(model), "cameras": [CAMERA], "input_px": MODEL_PX})
        rospy.set_param("/atlas/video_decoder", {"cameras": [CAMERA], "mono_cameras": []})

    def test_every_image_is_answered(self):
        with rosbag.Bag(str(self.folder / "a.bag"), "w") as bag:
            for index in range(IMAGES):
                message = image(index)
                bag.write(f"/{CAMERA}/image_raw", message, message.header.stamp)
        model = self.folder / "tiny.onnx"
        subprocess.run([roslib.packages.find_node("atlas_tests", "write_tiny_model")[0], str(model)], check=True)
        self.parameters(model)
        lock, received = threading.Lock(), []

        def keep(message):
            with lock:
                received.append(message)

        subscriber = rospy.Subscriber(f"/atlas/{CAMERA}/detections", Detection2dArray, keep, queue_size=1000)
        self.addCleanup(subscriber.unregister)
        self.nodelet("video_decoder", "atlas_loader/VideoDecoder")
        self.nodelet("detector", "atlas_fusion/Detector")
        rospy.set_param("/atlas/player", {"bag": str(self.folder / "a.bag"), "stages": ["video_decoder", "detector"]})
        player = self.nodelet("player", "atlas_loader/Player")
        output, _ = player.communicate(timeout=LIMIT_S)
        self.assertEqual(player.returncode, 0, output)
        deadline = time.monotonic() + LIMIT_S
        while time.monotonic() < deadline:
            with lock:
                if len(received) >= IMAGES - 1:
                    break
            time.sleep(0.05)
        self.judge(received)

    def judge(self, received):
        stamps = [m.header.stamp for m in received]
        expected = [image(i).header.stamp for i in range(IMAGES) if i != UNREADABLE]
        self.assertEqual(stamps, expected, "the unreadable image is counted by the decoder, every other one is answered in order")
        for message in received:
            self.assertEqual(message.header.frame_id, CAMERA)
            if message.header.stamp == image(NOTHING).header.stamp:
                self.assertEqual(message.detections, [])
                continue
            boxes = sorted(message.detections, key=lambda d: d.class_id)
            self.assertEqual([b.class_id for b in boxes], [0, 1])
            red, blue = boxes
            self.assertAlmostEqual(red.confidence, 1.0, delta=1 / 255)
            self.assertAlmostEqual(blue.confidence, 204 / 255, delta=1 / 255)
            # edges of pixels: the first pixel has its centre at 0
            for got, wanted in ((red.x_min, 31.5), (red.x_max, 47.5), (red.y_min, -0.5), (blue.x_min, -0.5), (blue.y_max, 31.5)):
                self.assertAlmostEqual(got, wanted, delta=1e-3)

    def test_a_model_that_is_none_is_refused(self):
        model = self.folder / "none.onnx"
        model.write_text("no model at all")
        self.parameters(model)
        detector = self.nodelet("detector", "atlas_fusion/Detector")
        output, _ = detector.communicate(timeout=LIMIT_S)
        self.assertNotEqual(detector.returncode, 0)
        self.assertIn(str(model), output)
        self.assertIn("not an ONNX model", output)


if __name__ == "__main__":
    rospy.init_node("detector_test", disable_rostime=True)
    rostest.rosrun("atlas_tests", "detector", Detector)
