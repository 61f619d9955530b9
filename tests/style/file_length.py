#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""No source is longer than 300 lines."""
from sources import CPP, files, finish, read, root

LIMIT = 300


def main():
    base = root()
    lengths = [(path, len(read(path))) for path in files(base, (*CPP, ".py"))]
    finish([(path, length, f"{length} lines, the limit is {LIMIT}") for path, length in lengths if length > LIMIT], base)


main()
