#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A folder of the core includes only folders to its left:
base <- sensor <- calibration <- {localization, lidar, camera, stereo} <- {fusion, grid, monitor} <- output <- pipeline."""
import re

from sources import CPP, files, finish, read, root

ORDER = [{"base"}, {"sensor"}, {"calibration"}, {"localization", "lidar", "camera", "stereo"}, {"fusion", "grid", "monitor"},
         {"output"}, {"pipeline"}]
RANK = {folder: rank for rank, folders in enumerate(ORDER) for folder in folders}
INCLUDE = re.compile(r'#\s*include\s*[<"](atlas/([^/">]+)[^">]*)[">]')


def main():
    base = root()
    core = base / "src/atlas_core/atlas"
    problems = []
    for path in files(base, CPP):
        if core not in path.parents:
            continue
        inner = path.relative_to(core)
        folder = inner.parts[0] if len(inner.parts) > 1 else inner.stem
        if folder not in RANK:
            problems.append((path, 1, f"folder '{folder}' has no place in the order of the core"))
            continue
        for number, line in enumerate(read(path), 1):
            match = INCLUDE.search(line)
            if not match:
                continue
            target = match.group(2).split(".")[0]
            if target == folder:
                continue
            if target not in RANK or RANK[target] >= RANK[folder]:
                problems.append((path, number, f"'{folder}' may not include '{match.group(1)}'"))
    finish(problems, base)


main()
