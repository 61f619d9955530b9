#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Labelled boxes of a nuScenes info file (mmdetection3d, version 1.1) as text.

nuscenes_boxes.py FILE.pkl prints one line an item, lengths in m:
  camera NAME fx fy cx cy, then T_camera_lidar as 12 numbers row by row
  box CLASS x y z length width height yaw points    (centre and yaw in the lidar frame, lidar points inside)
The file is a pickle: nothing but plain values and numbers of numpy is read from it, any other class is refused.
"""
import pickle
import struct
import sys

FORMATS = {"f4": "<f", "f8": "<d", "i4": "<i", "i8": "<q", "b1": "<?"}


class Dtype:
    def __init__(self, name, *_):
        self.format = FORMATS[name]

    def __setstate__(self, state):
        pass


def encode(text, encoding):
    return text.encode(encoding)


def scalar(dtype, value):
    return struct.unpack(dtype.format, value)[0]


class PlainUnpickler(pickle.Unpickler):
    KNOWN = {("numpy", "dtype"): Dtype, ("_codecs", "encode"): encode, ("numpy.core.multiarray", "scalar"): scalar}

    def find_class(self, module, name):
        if (module, name) not in self.KNOWN:
            raise pickle.UnpicklingError(f"{module}.{name} is not a plain value")
        return self.KNOWN[module, name]


def words(values):
    return " ".join(repr(float(value)) for value in values)


def main(path):
    with open(path, "rb") as file:
        info = PlainUnpickler(file).load()
    names = {label: name for name, label in info["metainfo"]["categories"].items()}
    for sample in info["data_list"]:
        for name, camera in sample["images"].items():
            (fx, _, cx), (_, fy, cy), _ = camera["cam2img"]
            print("camera", name, words((fx, fy, cx, cy)), words(sum(camera["lidar2cam"][:3], [])))
        for box in sample["instances"]:
            print("box", names.get(box["bbox_label_3d"], "other"), words(box["bbox_3d"]), int(box["num_lidar_pts"]))


if len(sys.argv) != 2:
    sys.exit(__doc__)
main(sys.argv[1])
