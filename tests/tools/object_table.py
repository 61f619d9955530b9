#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Objects on synthetic drives by lidar only, lidar and camera, and all sensors, as the table of tests/bench/BENCHMARK.md.

    ./atlas run python3 tests/tools/object_table.py DRIVES --seeds 21 22 23 --duration 12 --skip 8

A drive that is not there is made (make_drive, no pictures: the detections are enough), goes through track_drive once and
is judged by evaluate_run. Programs are looked for in PATH and in the workspace of `./atlas build`."""
import argparse
import json
import math
import shutil
import subprocess
import sys
from pathlib import Path

WORKSPACE = Path(__file__).resolve().parents[2] / ".build/ws/devel/lib/atlas_tests"
SENSORS = ("lidar", "lidar_camera", "all")


def program(name):
    found = shutil.which(name) or shutil.which(name, path=str(WORKSPACE))
    if not found:
        sys.exit(f"{name} is not built")
    return found


def run(*command):
    subprocess.run([str(c) for c in command], check=True, stdout=subprocess.DEVNULL)


def judged(folder, seed, options):
    """{sensors: group "objects" of evaluate_run} of one drive."""
    record, out = folder / f"drive_{seed}", folder / f"out_{seed}"
    if not (record / "truth" / "meta.json").exists():
        run(program("make_drive"), record, "--seed", seed, "--duration", options.duration, "--skip", options.skip,
            "--no-video", "--truth-points", 1, "--quiet")
    run(program("track_drive"), "--record", record, "--out", out)
    result = {}
    for sensors in SENSORS:
        scores = out / sensors / "scores.json"
        run(program("evaluate_run"), "--truth", record / "truth", "--out", out / sensors, "--json", scores)
        result[sensors] = json.loads(scores.read_text())["objects"]
    return result


def rms(parts):
    """Of (rmse, count)."""
    count = sum(n for _, n in parts)
    return math.sqrt(sum(value * value * n for value, n in parts) / count) if count else math.nan


def mean(drives, name):
    values = [d[name] for d in drives if name in d]
    return sum(values) / len(values) if values else math.nan


def total(drives, name):
    return sum(d[name] for d in drives)


def rows_of(drives):
    """(what, value) of some drives together; shares are means of the drives, errors are of all objects."""
    errors = total(drives, "missed") + total(drives, "wrong") + total(drives, "identity_switches")
    per_100 = 100.0 / total(drives, "object_seconds")
    class_right = mean(drives, "class_right_once_seen_by_camera_percent")  # without a camera none is told
    spread = lambda name: rms([(d[name]["rmse"], d[name]["count"]) for d in drives if name in d])
    return [
        ("MOTA, %", f"{100.0 * (1.0 - errors / total(drives, 'truths')):.1f}"),
        ("HOTA, %", f"{mean(drives, 'hota_percent'):.1f}"),
        ("IDF1, %", f"{mean(drives, 'idf1_percent'):.1f}"),
        ("true objects / missed / wrong", f"{total(drives, 'truths')} / {total(drives, 'missed')} / {total(drives, 'wrong')}"),
        ("identity switches per 100 object-seconds", f"{per_100 * total(drives, 'identity_switches'):.2f}"),
        ("speed error of moving objects, RMSE, m/s", f"{spread('speed_error_of_moving_mps'):.2f}"),
        ("position error, RMSE, m", f"{spread('position_error_m'):.2f}"),
        ("class right once a camera saw the object, %", f"{class_right:.1f}" if class_right > 0.0 else "-"),
        ("static or dynamic right, %", f"{mean(drives, 'motion_right_percent'):.1f}"),
        ("moving ones told as dynamic, %", f"{mean(drives, 'moving_told_as_dynamic_percent'):.1f}"),
        ("false dynamic, %", f"{mean(drives, 'false_dynamic_percent'):.1f}"),
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="where the drives are or are made")
    parser.add_argument("--seeds", type=int, nargs="+", default=list(range(21, 31)))
    parser.add_argument("--duration", type=float, default=30.0, help="s, of drives that are made")
    parser.add_argument("--skip", type=float, default=0.0, help="s, of drives that are made")
    options = parser.parse_args()
    drives = [judged(options.folder, seed, options) for seed in options.seeds]
    columns = [rows_of([drive[sensors] for drive in drives]) for sensors in SENSORS]
    print("| | lidar | lidar + camera | all |\n|---|---|---|---|")
    for cells in zip(*columns):
        print(f"| {cells[0][0]} | " + " | ".join(value for _, value in cells) + " |")


if __name__ == "__main__":
    main()
