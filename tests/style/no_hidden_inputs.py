#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Nothing but the data decides: no wall clock, no random seed, no unordered callbacks, no pairing by arrival."""
import re

from sources import CPP, files, finish, read, root

FORBIDDEN = {
    "ros::Time::now": "the time of an output is the stamp of its data",
    "ros::WallTime::now": "no wall clock",
    "system_clock": "no wall clock",
    "random_device": "random numbers come from a configured seed",
    "getMTNodeHandle": "callbacks of a stage run one after the other",
    "getMTPrivateNodeHandle": "callbacks of a stage run one after the other",
    "ApproximateTime": "inputs are merged by event time",
}
ALLOWED_BELOW = ("tests/bench/",)
COMMENT = re.compile(r"//.*$")


def main():
    base = root()
    problems = []
    for path in files(base, CPP):
        if path.relative_to(base).as_posix().startswith(ALLOWED_BELOW):
            continue
        for number, line in enumerate(read(path), 1):
            code = COMMENT.sub("", line)
            problems += [(path, number, f"{word}: {reason}") for word, reason in FORBIDDEN.items() if word in code]
    finish(problems, base)


main()
