#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Errors of positioning on synthetic drives and on real recordings, as tables for tests/bench/BENCHMARK.md.

    ./atlas run make_drive DIR/101 --seed 101 --duration 150 --no-cameras --no-lidar      # 101..120
    python3 tests/tools/positioning_table.py --localize PROGRAM [--synthetic DIR] [--data ATLAS_DATA]

Everything goes through atlas_localize; outages are rows left out of the GNSS file. Errors are horizontal: of the
filter at the end of the outage, of the smoother the largest inside it."""
import argparse
import bisect
import json
import math
import random
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, "/usr/lib/python3/dist-packages")  # rosbag
import positioning_data

FILTERS = ("eskf", "eskf + smoother", "kalman_1d")


def write(path, head, rows):
    path.write_text(head + "\n" + "".join(",".join(v if isinstance(v, str) else repr(v) for v in row) + "\n" for row in rows))


def read_tum(path):
    stamps, poses = [], []
    for line in path.read_text().splitlines():
        f = line.split()
        whole, part = f[0].split(".")
        stamps.append(int(whole) * 10**9 + int(part))
        poses.append(tuple(float(v) for v in f[1:8]))
    return stamps, poses


def yaw_of(q):
    x, y, z, w = q
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


class Run:
    """One drive through atlas_localize with one filter; the GNSS is silent from mask[0] to mask[1] (s)."""

    def __init__(self, program, drive, name, mask=None, lever=(0.0, 0.0, 0.0)):
        self.begin = drive["imu"][0][0]
        kept = [g for g in drive["gnss"] if not mask or not mask[0] < (g[0] - self.begin) / 1e9 <= mask[1]]
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            write(folder / "imu.csv", "stamp_ns,ax,ay,az,gx,gy,gz" + (",qx,qy,qz,qw" if len(drive["imu"][0]) > 7 else ""),
                  drive["imu"])
            write(folder / "gnss.csv", "stamp_ns,lat,lon,alt,sd_e,sd_n,sd_u" +
                  (",heading_deg,sd_heading" if len(kept[0]) > 7 else ""), kept)
            command = [program, "--imu", folder / "imu.csv", "--gnss", folder / "gnss.csv", "--out", folder / "out",
                       "--lever-arm", ",".join(map(str, lever)), "--filter", name]
            self.ok = subprocess.run(command, capture_output=True, check=False).returncode == 0
            self.tracks = {}
            if not self.ok:
                return
            anchor = json.loads((folder / "out/anchor.json").read_text())
            self.enu = positioning_data.Enu(anchor["latitude"], anchor["longitude"], anchor["altitude"])
            self.tracks[name] = read_tum(folder / "out/trajectory.tum")
            if name == "eskf":
                self.tracks["eskf + smoother"] = read_tum(folder / "out/smoothed.tum")

    def errors(self, name, drive):
        """(seconds, horizontal error m, heading error deg or None) at every reference row."""
        stamps, poses = self.tracks[name]
        result = []
        for row in drive["reference"]:
            i = bisect.bisect_left(stamps, row[0])
            if i == 0 or i >= len(stamps):
                continue
            k = (row[0] - stamps[i - 1]) / (stamps[i] - stamps[i - 1])
            x, y = ((1 - k) * poses[i - 1][j] + k * poses[i][j] for j in (0, 1))
            east, north, _ = self.enu.of(*row[1:4])
            turn = math.degrees(math.remainder(yaw_of(poses[i][3:7]) - row[4], 2 * math.pi)) if len(row) > 4 else None
            result.append(((row[0] - self.begin) / 1e9, math.hypot(x - east, y - north), turn))
        return result


def rms(values):
    values = list(values)
    return math.sqrt(sum(v * v for v in values) / len(values)) if values else float("nan")


def outages(program, drives, length, starts, lever=(0.0, 0.0, 0.0)):
    """Mean over all outages: error at the end (filters), largest error (smoother)."""
    sums = {name: [] for name in FILTERS}
    for drive in drives:
        for start in starts:
            for name in ("eskf", "kalman_1d"):
                run = Run(program, drive, name, (start, start + length), lever)
                for track in run.tracks:
                    inside = [e[1] for e in run.errors(track, drive) if start < e[0] <= start + length]
                    if inside:
                        sums[track].append(max(inside) if track == "eskf + smoother" else inside[-1])
    return {name: (sum(v) / len(v), len(v)) if v else (float("nan"), 0) for name, v in sums.items()}


def print_outages(title, program, drives, plan, lever=(0.0, 0.0, 0.0)):
    print(f"| {title} | " + " | ".join(FILTERS) + " |\n|---|" + "---|" * len(FILTERS))
    for length, starts in plan:
        result = outages(program, drives, length, starts, lever)
        print(f"| {length} s without GNSS | " + " | ".join(f"{result[n][0]:.2f} m ({result[n][1]})" for n in FILTERS) + " |",
              flush=True)


def synthetic(folder):
    """A record of make_drive; reference thinned to 10 Hz."""
    text = lambda name, separator: [[f for f in line.replace(separator, " ").split()]
                                    for line in (folder / name).read_text().splitlines() if line and line[0] != "#"]
    imu = [(int(f[0]), *(-float(v) for v in f[1:4]), *(float(v) for v in f[4:11])) for f in text("imu/imu.txt", ",")]
    gnss = []
    for f in text("gnss/pose.txt", ","):
        heading = (f[4], "3.0") if float(f[4]) != 0.0 else ("", "")
        gnss.append((int(f[0]), *(float(v) for v in f[1:4]), 0.02, 0.02, 0.035, *heading))
    anchor = json.loads((folder / "truth/anchor.json").read_text())
    enu = positioning_data.Enu(anchor["latitude"], anchor["longitude"], anchor["altitude"])
    stamps, poses = read_tum(folder / "truth/trajectory.tum")
    reference = [(s, *enu.inverse(*p[0:3]), yaw_of(p[3:7])) for s, p in list(zip(stamps, poses))[::40]]
    return {"imu": imu, "gnss": gnss, "reference": reference}


def synthetic_tables(program, folder):
    lever = (-0.48, -0.19, 0.0)
    drives = [synthetic(d) for d in sorted(folder.iterdir()) if (d / "truth").is_dir()]
    print(f"| {len(drives)} synthetic drives | horizontal RMSE | heading RMSE |\n|---|---|---|")
    for name in ("eskf", "kalman_1d"):
        errors = {}
        for drive in drives:
            run = Run(program, drive, name, lever=lever)
            for track in run.tracks:
                errors.setdefault(track, []).extend(e for e in run.errors(track, drive)
                                                    if e[0] > 10.0 or track == "eskf + smoother")
        for track, all_errors in errors.items():
            print(f"| {track} | {100 * rms(e[1] for e in all_errors):.2f} cm | {rms(e[2] for e in all_errors):.3f} deg |",
                  flush=True)
    print_outages("synthetic, city speed", program, drives, [(15, [70.0]), (30, [70.0]), (60, [70.0])], lever)


def real_tables(program, root):
    drive = positioning_data.walk(root)
    print_outages("gnss_imu_rtk_walk (on foot)", program, [drive], [(10, range(60, 87, 4)), (15, range(60, 82, 4)), (30, [60, 64])])
    drive = positioning_data.comma(root)
    for name in ("eskf", "kalman_1d"):
        run = Run(program, drive, name)
        for track in run.tracks:
            print(f"comma2k19_seg, fixes all the time, {track}: {rms(e[1] for e in run.errors(track, drive)):.2f} m RMSE")
    print_outages("comma2k19_seg", program, [drive], [(10, [20, 30, 40]), (30, [25])])
    drives = [positioning_data.kitti(root / "kitti_depth_0001/oxts", random.Random(seed)) for seed in range(101, 111)]
    for name in ("eskf", "kalman_1d"):
        errors = {}
        for drive in drives:
            run = Run(program, drive, name)
            for track in run.tracks:
                errors.setdefault(track, []).extend(run.errors(track, drive))
        for track, all_errors in errors.items():
            print(f"KITTI 0001, 1 Hz fixes of 2 m, {track}: {rms(e[1] for e in all_errors):.2f} m RMSE ({len(all_errors)} poses)")
    try:
        drive = positioning_data.husky(root)
    except ImportError:
        print("Husky: no python3-rosbag")
        return
    print_outages("Husky, reference = its own fixes", program, [drive], [(10, range(60, 360, 50)), (30, range(60, 350, 70)),
                                                                       (60, range(60, 320, 80))])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--localize", required=True, help="the program atlas_localize")
    parser.add_argument("--synthetic", type=Path, help="folder of records of make_drive")
    parser.add_argument("--data", type=Path, help="the real recordings")
    options = parser.parse_args()
    if options.data:
        real_tables(options.localize, options.data)
    if options.synthetic:
        synthetic_tables(options.localize, options.synthetic)


main()
