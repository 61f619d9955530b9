#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures whole runs on synthetic drives and prints the tables of tests/bench/BENCHMARK.md.

    ./atlas run python3 tests/tools/measure_runs.py [--seed 1] [--durations 30 120] [--update tests/bench/BENCHMARK.md]

For each drive: atlas_replay as it is, then with --write deskewed and evaluate_run. CPU time is user + system of the
process, so it counts the work and hardly depends on what else the machine does; wall time does, and is only worth
something at a low load, which is printed with it.
"""
import argparse
import datetime
import hashlib
import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# The program that the first paper's authors published, patched so that it survives, on such a drive on this kind of
# machine. There is no figure for what it was not measured for.
PUBLISHED = {"cpu": 2.9, "memory_gb": 0.98, "point_m": 0.86, "horizontal_m": 0.6, "heading_deg": 8.7}
BEGIN, END = "<!-- measured -->", "<!-- end of measured -->"
# group, quantity, statistic (None: a plain number), what it is called
ROWS = [
    ("trajectory", "horizontal_error_m", "rmse", "horizontal position error, RMSE, m"),
    ("trajectory", "vertical_error_m", "rmse", "vertical position error, RMSE, m"),
    ("trajectory", "heading_error_deg", "rmse", "heading error, RMSE, deg"),
    ("trajectory", "heading_error_deg", "max", "heading error, maximum, deg"),
    ("trajectory_after_5_s_of_driving", "horizontal_error_m", "rmse", "horizontal error after 5 s of driving, RMSE, m"),
    ("trajectory_after_5_s_of_driving", "heading_error_deg", "rmse", "heading error after 5 s of driving, RMSE, deg"),
    ("trajectory_after_5_s_of_driving", "heading_error_deg", "max", "heading error after 5 s of driving, maximum, deg"),
    ("trajectory", "roll_error_deg", "rmse", "roll error, RMSE, deg"),
    ("trajectory", "pitch_error_deg", "rmse", "pitch error, RMSE, deg"),
    ("trajectory", "stamps_answered_percent", None, "IMU stamps with a pose, %"),
    ("smoothed", "horizontal_error_m", "rmse", "smoothed: horizontal position error, RMSE, m"),
    ("smoothed", "vertical_error_m", "rmse", "smoothed: vertical position error, RMSE, m"),
    ("smoothed", "heading_error_deg", "rmse", "smoothed: heading error, RMSE, deg"),
    ("points", "static_error_m", "median", "point error in the map, median, m"),
    ("points", "static_error_m", "p95", "point error in the map, 95 %, m"),
    ("points", "static_error_after_5_s_of_driving_m", "median", "point error after 5 s of driving, median, m"),
    ("points", "static_error_after_5_s_of_driving_m", "p95", "point error after 5 s of driving, 95 %, m"),
    ("points", "distortion_m", "median", "distortion of a scan, median, m"),
    ("points", "distortion_m", "p95", "distortion of a scan, 95 %, m"),
    ("points", "noise_floor_median_m", None, "noise of the lidar alone, median, m"),
    ("points", "noise_floor_p95_m", None, "noise of the lidar alone, 95 %, m"),
    ("depth_camera_ir", "error_m", "median", "depth image of camera_ir, median error, m"),
    ("depth_camera_ir", "outliers_percent", None, "depth image of camera_ir, wrong by > 10 %, % of filled"),
    ("depth_camera_ir", "filled_percent", None, "depth image of camera_ir, filled, %"),
    ("frustums", "distance_error_m", "median", "distance of visible objects within 40 m, median error, m"),
    ("frustums", "distance_error_m", "p95", "distance of visible objects within 40 m, 95 %, m"),
    ("thermal_labels", "mean_overlap", None, "thermal labels, mean overlap with the true box"),
    ("thermal_labels", "mean_overlap_ceiling", None, "the same with true depth and exact geometry"),
    ("thermal_labels", "recall_within_40_m_percent", None, "thermal labels, visible objects within 40 m found, %"),
    ("thermal_labels", "of_nothing_percent", None, "thermal labels of nothing, %"),
    ("thermal_labels", "of_hidden_percent", None, "thermal labels of hidden objects, %"),
]


def program(name):
    """Path of a program of the workspace that `./atlas run` has entered."""
    for prefix in os.environ.get("CMAKE_PREFIX_PATH", "").split(":"):
        for path in sorted(Path(prefix).glob(f"lib/*/{name}")):
            return path
    sys.exit(f"measure_runs: {name} not found; start this with ./atlas run python3 {sys.argv[0]}")


def say(text):
    print(text, file=sys.stderr, flush=True)


def measured(command, log):
    """Runs a command to its end: wall s, CPU s (user + system), peak memory MB. Exits when it fails."""
    start = time.monotonic()
    with log.open("w") as output:
        child = subprocess.Popen([str(part) for part in command], stdout=output, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(child.pid, 0)
    wall = time.monotonic() - start
    if os.waitstatus_to_exitcode(status) != 0:
        sys.exit(f"measure_runs: {' '.join(map(str, command))} failed:\n{log.read_text()[-2000:]}")
    return {"wall_s": wall, "cpu_s": usage.ru_utime + usage.ru_stime, "memory_mb": usage.ru_maxrss / 1024.0}


def make_drive(folder, seed, duration):
    """The drive of ./atlas demo, made unless it is there from this very generator."""
    record = folder / f"drive_seed{seed}_{duration}s"
    maker = program("make_drive")
    stamp = f"{hashlib.sha256(maker.read_bytes()).hexdigest()} {seed} {duration}"
    complete = record.with_name(record.name + ".complete")
    if complete.exists() and complete.read_text().strip() == stamp:
        return record
    shutil.rmtree(record, ignore_errors=True)
    complete.unlink(missing_ok=True)
    folder.mkdir(parents=True, exist_ok=True)
    say(f"measure_runs: making a drive of {duration} s (seed {seed})")
    measured([maker, record, "--seed", seed, "--duration", duration, "--rgb-scale", "0.5", "--quiet"], folder / "make_drive.log")
    complete.write_text(stamp + "\n")
    return record


def measure(record, folder, repeats):
    """Both kinds of run of one drive: {"plain": ..., "deskewed": ..., "errors": evaluation}."""
    result = {}
    out = folder / f"out_{record.name}"
    for kind, options in (("plain", []), ("deskewed", ["--write", "deskewed"])):
        runs = []
        for number in range(repeats):
            shutil.rmtree(out, ignore_errors=True)
            say(f"measure_runs: replaying {record.name}, {kind}, {number + 1} of {repeats}")
            command = [program("atlas_replay"), "--record", record, "--out", out, *options]
            runs.append(measured(command, folder / "replay.log"))
        result[kind] = {key: sorted(run[key] for run in runs)[len(runs) // 2] for key in runs[0]}
        result[kind]["data_s"] = json.loads((out / "run.json").read_text())["timings"]["data_s"]
    say(f"measure_runs: comparing {record.name} with its truth")
    errors = folder / "evaluation.json"
    measured([program("evaluate_run"), "--truth", record / "truth", "--out", out, "--json", errors], folder / "evaluate.log")
    result["errors"] = json.loads(errors.read_text())
    shutil.rmtree(out)
    return result


def value_of(errors, group, quantity, statistic):
    """The number, or None when the evaluation does not have it."""
    value = errors.get(group, {}).get(quantity)
    return value.get(statistic) if statistic and value is not None else value


def text(value):
    return "-" if value is None else f"{value:.3g}" if abs(value) < 100 else f"{value:.0f}"


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def machine():
    """CPU model, cores, load, date, revision."""
    lines = Path("/proc/cpuinfo").read_text().splitlines()
    model = next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), "unknown CPU")
    revision = subprocess.run(["git", "-C", str(ROOT), "describe", "--always", "--dirty"], stdout=subprocess.PIPE, text=True,
                              check=False)
    return (f"{model}, {os.cpu_count()} cores; load {os.getloadavg()[0]:.2f} at the start; "
            f"{datetime.date.today().isoformat()}; revision {revision.stdout.strip() or 'unknown'}")


def speed_rows(results):
    for duration, result in results.items():
        for kind, name in (("plain", "no"), ("deskewed", "yes")):
            run = result[kind]
            cpu, wall = run["cpu_s"] / run["data_s"], run["wall_s"] / run["data_s"]
            yield [f"{duration} s", name, text(cpu), text(wall), text(run["memory_mb"])]


def comparison(results):
    """Beside the published program; the first drive stands for ours."""
    first = next(iter(results.values()))
    errors, run = first["errors"], first["plain"]
    ours = [
        ("CPU seconds per second of data", PUBLISHED["cpu"], run["cpu_s"] / run["data_s"]),
        ("peak memory, GB", PUBLISHED["memory_gb"], run["memory_mb"] / 1024.0),
        ("point error, median, m", PUBLISHED["point_m"], value_of(errors, "points", "static_error_m", "median")),
        ("horizontal position error, RMSE, m", PUBLISHED["horizontal_m"],
         value_of(errors, "trajectory", "horizontal_error_m", "rmse")),
        ("heading error, RMSE, deg", PUBLISHED["heading_deg"], value_of(errors, "trajectory", "heading_error_deg", "rmse")),
    ]
    return [[name, text(theirs), text(value), "-" if not value else f"{theirs / value:.3g} x"] for name, theirs, value in ours]


def error_rows(results):
    """What no drive has a number for is left out."""
    for *key, name in ROWS:
        values = [value_of(result["errors"], *key) for result in results.values()]
        if any(value is not None for value in values):
            yield [name, *map(text, values)]


def report(about, results, seed, repeats):
    """The tables as Markdown."""
    return "\n".join([
        f"{about}; seed {seed}; median of {repeats} run(s).\n",
        table(["drive", "writes de-skewed scans", "CPU s per s", "wall s per s", "peak memory, MB"], speed_rows(results)),
        table([f"drive of {next(iter(results))} s", "published program", "this suite", "better by"], comparison(results)),
        table(["error against the truth", *(f"{duration} s" for duration in results)],
              error_rows(results))])


def around(document):
    """Text before and after the marks of a document."""
    before, _, rest = document.read_text().partition(BEGIN)
    _, end, after = rest.partition(END)
    if not end:
        sys.exit(f"measure_runs: {document}: no '{BEGIN}' followed by '{END}'")
    return before, after


def update(document, tables):
    """Puts the tables between the two marks of a document."""
    before, after = around(document)
    document.write_text(f"{before}{BEGIN}\n\n{tables}\n{END}{after}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--durations", type=int, nargs="+", default=[30, 120], metavar="S")
    parser.add_argument("--repeats", type=int, default=1, metavar="N", help="runs of each kind, the median is printed")
    parser.add_argument("--folder", type=Path, default=ROOT / ".build/demo", help="for drives (kept) and outputs (removed)")
    parser.add_argument("--update", type=Path, metavar="FILE", help="put the tables between the marks of this document")
    parser.add_argument("--json", type=Path, metavar="FILE", help="all numbers")
    arguments = parser.parse_args()
    if arguments.update:
        around(arguments.update)  # what is wrong with it is better known before than after
    about = machine()
    results = {}
    for duration in arguments.durations:
        results[duration] = measure(make_drive(arguments.folder, arguments.seed, duration), arguments.folder, arguments.repeats)
    tables = report(about, results, arguments.seed, arguments.repeats)
    print(tables)
    if arguments.update:
        update(arguments.update, tables)
    if arguments.json:
        arguments.json.write_text(json.dumps({"about": about, "results": results}, indent=1) + "\n")


if __name__ == "__main__":
    main()
