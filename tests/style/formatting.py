#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Sources are formatted by clang-format 14 with the repository's .clang-format."""
import re
import shutil
import subprocess
import sys

from sources import CPP, SKIP_STATUS, files, finish, root


def formatter():
    for name in ("clang-format-14", "clang-format"):
        if shutil.which(name):
            version = subprocess.run([name, "--version"], capture_output=True, text=True, check=True).stdout
            if re.search(r"version 14\.", version):
                return name
    return None


def main():
    base = root()
    name = formatter()
    if name is None:
        print("clang-format 14 is not installed")
        sys.exit(SKIP_STATUS)
    paths = files(base, CPP)
    if not paths:
        return
    result = subprocess.run([name, "--dry-run", "--ferror-limit=1", *map(str, paths)], capture_output=True, text=True,
                            cwd=base, check=False)
    problems = {}
    for line in result.stderr.splitlines():
        match = re.match(r"(.+?):(\d+):\d+: (?:warning|error): code should be clang-formatted", line)
        if match:
            problems.setdefault(match.group(1), int(match.group(2)))
    finish([(base / path, line, f"not formatted ({name} -i)") for path, line in sorted(problems.items())], base)


main()
