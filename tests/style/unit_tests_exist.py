#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Lists the sources of the core without a unit test. A warning: it never fails.

Tested is a source whose header some test includes; one that implements part of another header, when a test is named after it."""
import re

from sources import CPP, files, read, root

INCLUDE = re.compile(r'#\s*include\s*[<"](atlas/[^">]+)[">]')


def main():
    base = root()
    sources = files(base, CPP)
    tested = {match.group(1) for path in sources if base / "tests" in path.parents
              for line in read(path) for match in [INCLUDE.search(line)] if match}
    core = base / "src/atlas_core"
    named = {path.stem for path in sources if base / "tests" in path.parents}
    missing = [path for path in sources if path.suffix == ".cpp" and core in path.parents
               and path.relative_to(core).with_suffix(".hpp").as_posix() not in tested
               and (path.with_suffix(".hpp").exists() or path.stem + "_test" not in named)]
    if missing:
        print(f"{len(missing)} core sources without a unit test: " + ", ".join(path.stem for path in missing))


main()
