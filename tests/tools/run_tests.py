#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs style checks, GoogleTest programs and ROS tests one after the other, each within a time limit.

Every test writes a JUnit file to build/test_results (catkin_test_results reads the same). Failures are printed in
detail; the last line is "N passed, N failed" and tells the exit status.
"""
import argparse
import os
import re
import shutil
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree as xml
from pathlib import Path

GTEST_LIMIT_S = 600
ROSTEST_LIMIT_S = 1500
STYLE_LIMIT_S = 120
REPORT_LINES = 60  # of one failed program
SKIP_STATUS = 77  # of a style check whose tool is not there


class Totals:
    """Counts of test cases, and what to say about the failed ones."""

    def __init__(self):
        self.passed = self.failed = self.skipped = 0
        self.reports = []

    def add(self, passed, failed, skipped, report=""):
        self.passed += passed
        self.failed += failed
        self.skipped += skipped
        if failed:
            self.reports.append(report)

    def line(self):
        text = f"{self.passed} passed, {self.failed} failed"
        return text + (f", {self.skipped} skipped" if self.skipped else "")


def run(command, limit_s, log, label, environment=None):
    """Exit status of the command, or None when it was ended after limit_s. Its output goes to `log`."""
    log.parent.mkdir(parents=True, exist_ok=True)
    with open(log, "wb") as output:
        process = subprocess.Popen(command, stdout=output, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                                   start_new_session=True, env=environment)
        start = said = time.monotonic()
        try:
            while True:
                try:
                    return process.wait(timeout=1)
                except subprocess.TimeoutExpired:
                    now = time.monotonic()
                if now - start > limit_s:
                    return None
                if now - said > 20:
                    said = now
                    print(f"    {label}: running for {now - start:.0f} s", flush=True)
        finally:
            end_group(process)


def end_group(process):
    """Ends what is left of the command's process group."""
    for number, patience_s in ((signal.SIGINT, 5), (signal.SIGKILL, 1)):
        try:
            os.killpg(process.pid, number)
        except ProcessLookupError:
            return
        limit = time.monotonic() + patience_s
        while time.monotonic() < limit:
            process.poll()
            try:
                os.killpg(process.pid, 0)
            except ProcessLookupError:
                return
            time.sleep(0.05)


def read_junit(path):
    """(passed, failed, skipped, text of the failures), or None when the file is missing or unreadable."""
    try:
        root = xml.parse(path).getroot()
    except (OSError, xml.ParseError):
        return None
    passed = failed = skipped = 0
    text = []
    for case in root.iter("testcase"):
        problems = case.findall("failure") + case.findall("error")
        if problems:
            failed += 1
            text.append(f"  {case.get('classname')}.{case.get('name')}")
            text += ["    " + line for p in problems for line in (p.text or p.get("message") or "").strip().split("\n")]
        elif case.find("skipped") is not None or case.get("result") == "skipped" or case.get("status") == "notrun":
            skipped += 1
        else:
            passed += 1
    return passed, failed, skipped, "\n".join(text)


def tail(path, lines=25):
    with open(path, errors="replace") as log:
        return "\n".join("    " + line.rstrip() for line in log.readlines()[-lines:])


def judge(name, status, junit, log, totals):
    """Adds one finished program to the totals; returns the counts (passed, failed, skipped)."""
    result = read_junit(junit)
    passed, failed, skipped, text = result or (0, 0, 0, "")
    if status is None:
        failed += 1
        text += f"\n  {name}: ended after its time limit; last lines:\n{tail(log)}"
    elif status < 0:
        failed += 1
        text += f"\n  {name}: ended by signal {-status} ({signal.Signals(-status).name}); last lines:\n{tail(log)}"
    elif result is None or (status != 0 and failed == 0) or passed + failed + skipped == 0:
        failed += 1
        text += f"\n  {name}: exit status {status}, no usable test result; last lines:\n{tail(log)}"
    totals.add(passed, failed, skipped, f"{name} (log: {log})\n{text}")
    return passed, failed, skipped


def write_junit(path, name, failure, skipped):
    suite = xml.Element("testsuite", name="style", tests="1", failures=str(int(bool(failure))), errors="0")
    case = xml.SubElement(suite, "testcase", classname="style", name=name)
    if failure:
        xml.SubElement(case, "failure", message="style").text = failure
    if skipped:
        xml.SubElement(case, "skipped")
    path.parent.mkdir(parents=True, exist_ok=True)
    xml.ElementTree(suite).write(path)


def run_style(root, results, wanted, totals):
    checks = [c for c in sorted((root / "tests/style").glob("*.py")) if c.stem != "sources" and wanted(f"style/{c.stem}")]
    warnings = []
    before = (totals.passed, totals.failed, totals.skipped)
    for check in checks:
        log = results / f"style-{check.stem}.log"
        status = run([sys.executable, str(check), str(root)], STYLE_LIMIT_S, log, check.stem)
        text = log.read_text(errors="replace").strip()
        skipped = status == SKIP_STATUS
        failure = "" if status == 0 or skipped else text or f"exit status {status}"
        write_junit(results / f"style-{check.stem}.xml", check.stem, failure, skipped)
        totals.add(int(status == 0), int(bool(failure)), int(skipped), f"style/{check.stem}\n{failure}")
        if text and not failure:
            warnings.append(f"    {check.stem}: {text.splitlines()[0]}")
    if checks:
        print_group("style", len(checks), "checks", before, totals, 0)
        print("\n".join(warnings) + "\n" if warnings else "", end="", flush=True)


def print_group(name, programs, noun, before, totals, start):
    passed, failed, skipped = (totals.passed - before[0], totals.failed - before[1], totals.skipped - before[2])
    line = f"  {name:<20} {programs:3d} {noun:<9} {passed:4d} passed"
    line += f", {failed} FAILED" if failed else ""
    line += f", {skipped} skipped" if skipped else ""
    print(line + (f"  ({time.monotonic() - start:.1f} s)" if start else ""), flush=True)


def show_current(name):
    """On a terminal: the name of the running program, replaced by the next line."""
    if sys.stdout.isatty():
        print(f"\r\033[K  {name} ...", end="\r", flush=True)
        print("\033[K", end="")


def launched_programs(launch_tests):
    """Names of programs that belong to ROS tests and need a master."""
    return {name for path in launch_tests for name in re.findall(r'type="([^"]+)"', path.read_text())}


def run_gtests(manifest, results, wanted, launched, totals):
    groups = {}
    for line in manifest.read_text().splitlines():
        kind, folder, name, path = line.split("\t")
        if kind == "gtest" and name not in launched and wanted(f"{folder}/{name}"):
            groups.setdefault(folder, []).append((name, path))
    for folder, programs in groups.items():
        start, before = time.monotonic(), (totals.passed, totals.failed, totals.skipped)
        for name, path in sorted(programs):
            show_current(name)
            junit, log = results / f"gtest-{name}.xml", results / f"gtest-{name}.log"
            status = run([path, f"--gtest_output=xml:{junit}"], GTEST_LIMIT_S, log, name)
            counts = judge(f"{folder}/{name}", status, junit, log, totals)
            if counts[1]:
                print(f"    FAILED {name}", flush=True)
        print_group(folder, len(programs), "programs", before, totals, start)


def run_rostests(launch_tests, results, wanted, totals):
    for path in launch_tests:
        name = f"{path.parent.name}/{path.stem}"
        if not wanted(name):
            continue
        show_current(name)
        start, before = time.monotonic(), (totals.passed, totals.failed, totals.skipped)
        base = results / f"rostest-{path.parent.name}-{path.stem}"
        log = results / f"rostest-{path.parent.name}-{path.stem}.log"
        status = run(["rostest", "--results-base-dir", str(base), "--results-filename", "result.xml", str(path)],
                     ROSTEST_LIMIT_S, log, name)
        junit = next(iter(sorted(base.rglob("*.xml"))), base / "missing.xml")
        judge(name, status, junit, log, totals)
        print_group(name, 1, "launch", before, totals, start)


def run_scripts(scripts, results, wanted, totals):
    """Tests of whole runs: programs that write their own JUnit file."""
    for path in scripts:
        name = f"{path.parent.name}/{path.stem}"
        if not wanted(name):
            continue
        show_current(name)
        start, before = time.monotonic(), (totals.passed, totals.failed, totals.skipped)
        junit, log = results / f"script-{path.stem}.xml", results / f"script-{path.stem}.log"
        status = run([sys.executable, str(path), "--junit", str(junit)], ROSTEST_LIMIT_S, log, name)
        judge(name, status, junit, log, totals)
        print_group(name, 1, "script", before, totals, start)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], prog="./atlas test")
    parser.add_argument("--root", type=Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--workspace", type=Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--filter", default="", metavar="RE", help="only tests whose folder/name matches")
    parser.add_argument("--no-ros", action="store_true", help="without the tests that start ROS nodes")
    arguments = parser.parse_args()
    pattern = re.compile(arguments.filter)
    results = arguments.workspace / "build/test_results/atlas_tests"
    shutil.rmtree(results, ignore_errors=True)
    results.mkdir(parents=True)
    launch_tests = sorted([*(arguments.root / "tests/ros").glob("*.test"), *(arguments.root / "tests/replay").glob("*.test")])
    totals = Totals()
    print("test:", flush=True)
    run_style(arguments.root, results, pattern.search, totals)
    run_gtests(arguments.workspace / "build/atlas_tests/tests.manifest", results, pattern.search,
               launched_programs(launch_tests), totals)
    if not arguments.no_ros:
        run_rostests(launch_tests, results, pattern.search, totals)
        run_scripts(sorted((arguments.root / "tests/replay").glob("*_test.py")), results, pattern.search, totals)
    for report in totals.reports:
        lines = report.rstrip().split("\n")
        print("\nFAILED " + "\n".join(lines[:REPORT_LINES]))
        if len(lines) > REPORT_LINES:
            print(f"  ... {len(lines) - REPORT_LINES} more lines")
    print(totals.line(), flush=True)
    return 1 if totals.failed or totals.passed == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
