#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the Google Benchmark programs one after the other and merges their results into one JSON file."""
import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path


def programs(manifest):
    for line in manifest.read_text().splitlines():
        kind, _, name, path = line.split("\t")
        if kind == "bench":
            yield name, path


def main():
    parser = argparse.ArgumentParser(description=__doc__, prog="./atlas bench")
    parser.add_argument("--workspace", type=Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--filter", default=".", metavar="RE", help="only benchmarks whose name matches")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all results to FILE")
    arguments = parser.parse_args()
    merged = {"context": None, "benchmarks": []}
    failed = []
    for name, path in sorted(programs(arguments.workspace / "build/atlas_tests/tests.manifest")):
        with tempfile.NamedTemporaryFile(suffix=".json") as result:
            print(f"bench: {name}", flush=True)
            status = subprocess.run([path, f"--benchmark_filter={arguments.filter}", "--benchmark_out_format=json",
                                     f"--benchmark_out={result.name}"], check=False).returncode
            text = Path(result.name).read_text()
        if status != 0:
            failed.append(name)
        if not text.strip():  # nothing matched the filter
            continue
        data = json.loads(text)
        merged["context"] = merged["context"] or data["context"]
        merged["benchmarks"] += [{"program": name, **entry} for entry in data["benchmarks"]]
    if arguments.json:
        arguments.json.parent.mkdir(parents=True, exist_ok=True)
        arguments.json.write_text(json.dumps(merged, indent=1) + "\n")
        print(f"bench: {len(merged['benchmarks'])} results in {arguments.json}")
    if failed:
        print(f"bench: failed: {', '.join(failed)}", file=sys.stderr)
    return 1 if failed or not merged["benchmarks"] else 0


if __name__ == "__main__":
    sys.exit(main())
