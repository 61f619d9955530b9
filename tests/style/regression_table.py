#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The table in tests/README.md names tests that exist, has a row for each of W1..W25, and misses no test named after one."""
import re

from sources import CPP, files, finish, read, root

ROW = re.compile(r"^\| (W\d+) \|")
TEST = re.compile(r"^TEST(?:_F|_P)?\((\w+), (\w+)\)")
NUMBERED = re.compile(r"W\d+(?=_)")


def main():
    base = root()
    table = base / "tests/README.md"
    if not table.exists():
        return
    tests = {f"{match.group(1)}.{match.group(2)}": (path, number) for path in files(base, CPP) if base / "tests" in path.parents
             for number, line in enumerate(read(path), 1) for match in [TEST.match(line)] if match}
    listed, problems = {}, []
    for number, line in enumerate(read(table), 1):
        row = ROW.match(line)
        if not row:
            continue
        names = re.findall(r"`(\w+\.\w+)`", line)
        listed[row.group(1)] = names
        problems += [(table, number, f"there is no test {name}") for name in names if name not in tests]
        if not names and "later" not in line:
            problems.append((table, number, f"{row.group(1)} has neither a test nor the word 'later'"))
    problems += [(table, 1, f"no row for W{i}") for i in range(1, 26) if f"W{i}" not in listed]
    for name, (path, number) in sorted(tests.items()):
        for wrong in NUMBERED.findall(name.split(".")[1]):
            if name not in listed.get(wrong, []):
                problems.append((path, number, f"{name} is not in the row of {wrong} in tests/README.md"))
    finish(problems, base)


main()
