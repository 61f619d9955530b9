#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The core includes nothing of ROS: no ros/, no message package, no tf, no nodelet."""
import re

from sources import CPP, files, finish, read, root

ROS = re.compile(r'#\s*include\s*[<"]((?:ros|rosbag|tf|tf2|tf2_\w+|nodelet|pluginlib|cv_bridge|image_transport|atlas_ros|\w+_msgs|'
                 r'diagnostic_updater|message_filters|sensor_msgs)/[^">]*)[">]')


def main():
    base = root()
    problems = [(path, number, f"ROS in the core: {match.group(1)}")
                for path in files(base, CPP) if base / "src/atlas_core" in path.parents
                for number, line in enumerate(read(path), 1) for match in [ROS.search(line)] if match]
    finish(problems, base)


main()
