#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Every source begins with its licence (the first line, the second after #!)."""
from sources import CPP, files, finish, read, root


def is_script(path):
    return path.suffix in (".py", ".sh") or (not path.suffix and path.read_bytes()[:2] == b"#!")


def main():
    base = root()
    problems = []
    for path in files(base):
        if path.suffix not in CPP and not is_script(path):
            continue
        lines = read(path)
        first = 1 if lines and lines[0].startswith("#!") else 0
        if len(lines) <= first or "SPDX-License-Identifier: MIT" not in lines[first]:
            problems.append((path, first + 1, "SPDX-License-Identifier: MIT is missing"))
    finish(problems, base)


main()
