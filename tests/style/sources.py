# SPDX-License-Identifier: MIT
"""What the style checks share: the files of the repository and the way to report."""
import subprocess
import sys
from pathlib import Path

CPP = (".cpp", ".hpp", ".h", ".cc")
SKIP_STATUS = 77
IGNORED = {"out", "__pycache__", "build", "devel", "install"}


def root():
    """Repository root: first argument, else found from this file."""
    return Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else Path(__file__).resolve().parents[2]


def files(base, suffixes=None):
    """Files of the repository in order: what git knows or would add, without git whatever is not hidden."""
    listed = subprocess.run(["git", "-C", str(base), "ls-files", "-co", "--exclude-standard"], capture_output=True,
                            text=True, check=False)
    if listed.returncode == 0 and listed.stdout:
        paths = [base / line for line in listed.stdout.splitlines()]
    else:
        paths = [p for p in base.rglob("*") if not any(part.startswith(".") or part in IGNORED
                                                       for part in p.relative_to(base).parts)]
    return sorted({p for p in paths if p.is_file() and (suffixes is None or p.suffix in suffixes)})


def read(path):
    return path.read_text(encoding="utf-8", errors="replace").splitlines()


def finish(problems, base):
    """Prints `file:line: text` for each (path, line, text) and ends the check."""
    for path, line, text in problems:
        print(f"{path.relative_to(base)}:{line}: {text}")
    sys.exit(1 if problems else 0)
