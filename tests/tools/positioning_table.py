#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Errors of positioning on synthetic drives and on real recordings, as tables for tests/bench/BENCHMARK.md.

    ./atlas run make_drive DIR/101 --seed 101 --duration 150 --no-cameras --no-lidar      # 101..120
    ./atlas run make_drive STOPS/101 --seed 101 --duration 130 --stop-at 40 --stop-for 70 --no-cameras --no-lidar
    python3 tests/tools/positioning_table.py --localize PROGRAM [--synthetic DIR] [--stops STOPS] [--data ATLAS_DATA]

Everything goes through atlas_localize; outages are rows left out of the GNSS file. Errors are horizontal: of the
filter at the end of the outage, of the smoother the largest inside it. NEES: squared error over its covariance, 3
components, so 3 on average when the covariance is honest."""
import argparse
import json
import math
import random
import statistics
import sys
from pathlib import Path

sys.path.insert(0, "/usr/lib/python3/dist-packages")  # rosbag
import positioning_data
from positioning_run import Prepared, Run, pose_of, tum_lines

FILTERS = ("eskf", "eskf + smoother", "kalman_1d")
LEVER = (-0.48, -0.19, 0.0)  # rear antenna of the synthetic rig
STARTS = 4  # outages a drive


def rms(values):
    values = list(values)
    return math.sqrt(sum(v * v for v in values) / len(values)) if values else math.nan


def mean(values):
    values = list(values)
    return sum(values) / len(values) if values else math.nan


def line(*cells):
    print("| " + " | ".join(cells) + " |", flush=True)


def head(*cells):
    line(*cells)
    print("|" + "---|" * len(cells))


def chi_square_bounds(freedom, runs):
    """95 % of the mean of `runs` chi-square variables (Wilson and Hilferty 1931; to 0.01 here)."""
    k = freedom * runs
    return [k * (1 - 2 / (9 * k) + z * math.sqrt(2 / (9 * k))) ** 3 / runs for z in (-1.959964, 1.959964)]


def outage_errors(program, prepared, length, start, lever=(0.0, 0.0, 0.0)):
    """{filter: error of this outage}; none of a filter that gave no pose."""
    result = {}
    for name in ("eskf", "kalman_1d"):
        run = Run(program, prepared, name, (start, start + length), lever=lever)
        for track in run.tracks:
            inside = [e["horizontal"] for e in run.errors(track, start, start + length)]
            if inside:
                result[track] = max(inside) if track == "eskf + smoother" else inside[-1]
    return result


def outage_table(title, program, plan, lever=(0.0, 0.0, 0.0)):
    """plan: {length s: [(prepared drive, start s)]}."""
    head(title, *(f"{name}: mean, median, largest" for name in FILTERS))
    for length, cases in plan.items():
        found = [outage_errors(program, prepared, length, start, lever) for prepared, start in cases]
        cells = []
        for name in FILTERS:
            values = [f[name] for f in found if name in f]
            cells.append(f"{mean(values):.2f}, {statistics.median(values):.2f}, {max(values):.2f} m ({len(values)})" if values else "no pose")
        line(f"{length} s without GNSS", *cells)


def synthetic(folder):
    """A record of make_drive; reference thinned to 10 Hz: stamp, lat, lon, alt, quaternion, velocity in map."""
    text = lambda name, separator: [row.replace(separator, " ").split() for row in (folder / name).read_text().splitlines()]
    imu = [(int(f[0]), *(-float(v) for v in f[1:4]), *(float(v) for v in f[4:11])) for f in text("imu/imu.txt", ",")]
    gnss = []
    for f in text("gnss/pose.txt", ","):
        heading = (f[4], "3.0") if float(f[4]) != 0.0 else ("", "")
        gnss.append((int(f[0]), *(float(v) for v in f[1:4]), 0.02, 0.02, 0.035, *heading))
    anchor = json.loads((folder / "truth/anchor.json").read_text())
    enu = positioning_data.Enu(anchor["latitude"], anchor["longitude"], anchor["altitude"])
    stamps, lines = tum_lines(folder / "truth/trajectory.tum")
    reference = []
    for i in range(40, len(stamps) - 1, 40):
        before, pose, after = (pose_of(lines[i + k]) for k in (-1, 0, 1))
        velocity = [(b - a) / ((stamps[i + 1] - stamps[i - 1]) / 1e9) for a, b in zip(before[:3], after[:3])]
        reference.append((stamps[i], *enu.inverse(*pose[0:3]), pose[3:7], velocity))
    return {"imu": imu, "gnss": gnss, "reference": reference}


def drives_in(folder):
    return [synthetic(d) for d in sorted(folder.iterdir()) if (d / "truth").is_dir()]


def accuracy_tables(program, drives):
    """All drives whole: errors, and whether the covariances say so."""
    errors = {}  # per filter, per drive
    for drive in drives:
        with Prepared(drive) as prepared:
            for name in ("eskf", "kalman_1d"):
                run = Run(program, prepared, name, lever=LEVER, covariances=name == "eskf")
                for track in run.tracks:
                    errors.setdefault(track, []).append(run.errors(track, 0.0 if track == "eskf + smoother" else 10.0))
    head(f"{len(drives)} synthetic drives", "horizontal RMSE", "heading RMSE", "roll RMSE", "pitch RMSE")
    for track, runs in errors.items():
        whole = [e for run in runs for e in run]
        line(track, f"{100 * rms(e['horizontal'] for e in whole):.2f} cm",
             *(f"{rms(e[axis] for e in whole):.3f} deg" for axis in ("yaw", "roll", "pitch")))
    low, high = chi_square_bounds(3, len(drives))
    head(f"NEES, mean of {len(drives)} drives", "position", "velocity", "attitude")
    for track, runs in errors.items():
        if "position" not in runs[0][0]:
            continue
        cells = []
        for what in ("position", "velocity", "attitude"):
            moments = {}
            for run in runs:
                for e in run:
                    moments.setdefault(round(e["t"], 1), []).append(e[what])
            means = [mean(m) for m in moments.values() if len(m) == len(drives)]
            inside, below = (100 * sum(a <= m <= b for m in means) / len(means) for a, b in ((low, high), (0.0, low)))
            cells.append(f"{mean(means):.2f} ({inside:.0f} % of the moments in {low:.2f}..{high:.2f}, {below:.0f} % below)")
        line(track, *cells)


def outage_starts(number, count=STARTS, first_s=20.0, last_s=88.0):
    """Spread over the drive, others in each one (golden section), so that they fall into turns, stops and straights."""
    step = (last_s - first_s) / count
    return [first_s + step * (k + 0.618034 * number % 1.0) for k in range(count)]


def synthetic_outages(program, drives):
    prepared = [Prepared(drive) for drive in drives]
    cases = [(p, start) for number, p in enumerate(prepared) for start in outage_starts(number)]
    outage_table(f"synthetic, {STARTS} outages a drive", program, {length: cases for length in (15, 30, 60)}, LEVER)


def standstill(drive):
    """Begin of the longest standstill, s after the first sample."""
    begin, best, length = None, 0.0, 0.0
    for row in drive["reference"]:
        t = (row[0] - drive["imu"][0][0]) / 1e9
        if math.hypot(*row[5]) > 1e-5:
            begin = None
            continue
        begin = t if begin is None else begin
        if t - begin > length:
            best, length = begin, t - begin
    return best


def standstill_table(program, drives):
    drifts = {}
    for drive in drives:
        with Prepared(drive) as prepared:
            lost = standstill(drive) + 3.0
            for name in ("eskf", "kalman_1d"):
                run = Run(program, prepared, name, blind=(lost, lost + 60.0), lever=LEVER)
                for track in run.tracks:
                    yaw = [e["yaw"] for e in run.errors(track, lost, lost + 60.0)]
                    drifts.setdefault(track, []).append(
                        max(abs(y - yaw[0]) for y in yaw) if track == "eskf + smoother" else abs(yaw[-1] - yaw[0]))
    head(f"heading lost for 60 s at standstill, {len(drives)} drives", *FILTERS)
    line("drift of the heading: mean, largest", *(f"{mean(drifts[n]):.3f}, {max(drifts[n]):.3f} deg" for n in FILTERS))


def real(drive):
    """eskf runs out of the box; kalman_1d has roll and pitch from the IMU's own orientation, where there is one."""
    return Prepared(drive, own_only_for="kalman_1d")


def whole_run(title, program, drives):
    errors = {name: [] for name in FILTERS}
    for drive in drives:
        with real(drive) as prepared:
            for name in ("eskf", "kalman_1d"):
                run = Run(program, prepared, name)
                for track in run.tracks:
                    errors[track].extend(e["horizontal"] for e in run.errors(track))
    line(title, *(f"{rms(errors[n]):.2f} m RMSE ({len(errors[n])} poses)" if errors[n] else "no pose" for n in FILTERS))


def kitti_tables(program, root):
    head("KITTI oxts, fixes of 1 Hz and 2 m, ten seeds", *FILTERS)
    for name in ("kitti_depth_0001", "kitti_tracking_0012", "kitti_raw_0052"):
        for heading_deg in (None, 3.0):
            drives = [positioning_data.kitti(root / name / "oxts", random.Random(seed), heading_deg=heading_deg)
                      for seed in range(101, 111)]
            span = (drives[0]["imu"][-1][0] - drives[0]["imu"][0][0]) / 1e9
            whole_run(f"{name}, {span:.1f} s" + (", heading of 3 deg" if heading_deg else ""), program, drives)
    drives = [positioning_data.kitti(root / "kitti_depth_0001/oxts", random.Random(seed), heading_deg=3.0)
              for seed in range(101, 111)]
    prepared = [real(drive) for drive in drives]
    outage_table("kitti_depth_0001, heading of 3 deg, outage from 4.5 s on", program, {5: [(p, 4.5) for p in prepared]})


def every_5_s(prepared, first_s, last_s):
    """Outages of 10, 15 and 30 s that begin at every 5 s and end by last_s."""
    return {length: [(prepared, s) for s in range(first_s, last_s - length + 1, 5)] for length in (10, 15, 30)}


def real_tables(program, root):
    walk = real(positioning_data.walk(root))
    outage_table("gnss_imu_rtk_walk (on foot)", program, every_5_s(walk, 55, 97))
    drive = positioning_data.comma(root)
    head("comma2k19_seg", *FILTERS)
    whole_run("fixes all the time", program, [drive])
    outage_table("comma2k19_seg", program, every_5_s(real(drive), 15, 59))
    kitti_tables(program, root)
    try:
        husky = real(positioning_data.husky(root))
    except ImportError:
        print("Husky: no python3-rosbag")
        return
    head("Husky, reference = its own fixes", *FILTERS)
    whole_run("fixes all the time", program, [husky.drive])
    outage_table("Husky, reference = its own fixes", program, {10: [(husky, s) for s in range(60, 360, 25)],
                                                               30: [(husky, s) for s in range(60, 350, 35)],
                                                               60: [(husky, s) for s in range(60, 320, 50)]})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--localize", required=True, help="the program atlas_localize")
    parser.add_argument("--synthetic", type=Path, help="folder of records of make_drive")
    parser.add_argument("--stops", type=Path, help="folder of records with a stop of more than a minute")
    parser.add_argument("--data", type=Path, help="the real recordings")
    options = parser.parse_args()
    if options.data:
        real_tables(options.localize, options.data)
    if options.stops:
        standstill_table(options.localize, drives_in(options.stops))
    if options.synthetic:
        drives = drives_in(options.synthetic)
        accuracy_tables(options.localize, drives)
        synthetic_outages(options.localize, drives)


main()
