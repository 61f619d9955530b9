#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Lists the sources of the core that no unit test includes. A warning: it never fails."""
import re

from sources import CPP, files, read, root

INCLUDE = re.compile(r'#\s*include\s*[<"](atlas/[^">]+)[">]')


def main():
    base = root()
    sources = files(base, CPP)
    tested = {match.group(1) for path in sources if base / "tests" in path.parents
              for line in read(path) for match in [INCLUDE.search(line)] if match}
    core = base / "src/atlas_core"
    missing = [path for path in sources if path.suffix == ".cpp" and core in path.parents
               and path.relative_to(core).with_suffix(".hpp").as_posix() not in tested]
    names = [path.stem for path in missing]
    if missing:
        print(f"{len(missing)} core sources without a unit test: " + ", ".join(path.stem for path in missing))


main()
