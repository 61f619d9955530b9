#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Each style check finds the violation that it is for, at its file and line, and is silent about a clean tree."""
import subprocess
import sys
import tempfile
from pathlib import Path

from sources import SKIP_STATUS

LICENCE = "// SPDX-License-Identifier: MIT\n"
HERE = Path(__file__).resolve().parent
# check -> file, text, what must be printed
CASES = {
    "folder_order": ("src/atlas_core/atlas/lidar/a.hpp", LICENCE + '#include "atlas/camera/camera_model.hpp"\n', "a.hpp:2:"),
    "no_ros_in_core": ("src/atlas_core/atlas/base/a.hpp", LICENCE + "#include <sensor_msgs/Imu.h>\n", "a.hpp:2:"),
    "spdx_line": ("atlas_msgs/a.cpp", "int a;\n", "a.cpp:1:"),
    "file_length": ("atlas_msgs/a.cpp", LICENCE + "\n" * 300, "a.cpp:301:"),
    "no_hidden_inputs": ("atlas_lidar/src/a.cpp", LICENCE + "auto t = ros::Time::now();\n", "a.cpp:2:"),
    "formatting": ("atlas_lidar/src/a.cpp", LICENCE + "int  a ;\n", "a.cpp:2:"),
    "regression_table": ("tests/README.md", "| W1 | wrong | `Some.Test` | covered |\n", "README.md:1: there is no test"),
    "plain_words": ("atlas_bringup/launch/a.launch", '<arg name="a" default="' + "/home" + '/me/a"/>\n', "a.launch:1:"),
}


def check(name, base):
    return subprocess.run([sys.executable, str(HERE / f"{name}.py"), str(base)], capture_output=True, text=True, check=False)


def main():
    problems = []
    for name, (path, text, expected) in CASES.items():
        with tempfile.TemporaryDirectory() as directory:
            base = Path(directory).resolve()
            (base / ".clang-format").write_text("BasedOnStyle: Google\n")
            clean = check(name, base)
            (base / path).parent.mkdir(parents=True)
            (base / path).write_text(text)
            broken = check(name, base)
        if SKIP_STATUS in (clean.returncode, broken.returncode):
            continue
        if clean.returncode != 0:
            problems.append(f"{name}: fails on an empty tree: {clean.stdout}{clean.stderr}")
        if broken.returncode != 1 or expected not in broken.stdout:
            problems.append(f"{name}: does not see its violation: {broken.stdout}{broken.stderr}")
    print("\n".join(problems))
    sys.exit(1 if problems else 0)


main()
