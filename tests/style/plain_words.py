#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""No unfinished business and no paths of one machine in what is shipped."""
import re

from sources import files, finish, read, root

SUFFIXES = (".cpp", ".hpp", ".h", ".py", ".launch", ".test", ".yaml", ".xml", ".md", ".txt", ".msg", ".cmake", ".rviz", "")
PATTERN = re.compile(r"\b(TODO|FIXME|XXX|HACK)\b|(?<![\w.])/(?:work|home|root|tmp)/\w")
ALLOWED = ("tests/style/",)


def main():
    base = root()
    problems = [(path, number, f"'{match.group(0)}'")
                for path in files(base, SUFFIXES) if not path.relative_to(base).as_posix().startswith(ALLOWED)
                for number, line in enumerate(read(path), 1) for match in [PATTERN.search(line)] if match]
    finish(problems, base)


main()
