"""Checks that clang-format would change nothing (Google style, 100 columns)."""

import subprocess

from files import project_files

PROGRAM = "clang-format-14"


def violations(root):
    files = [str(path) for path in project_files(root, (".h", ".cc"))]
    run = subprocess.run([PROGRAM, "--dry-run", "--Werror", *files], cwd=root,
                         capture_output=True, text=True, check=False)
    if run.returncode == 0:
        return []
    return sorted({line.split(" error:")[0] + " not formatted: run clang-format-14 -i"
                   for line in run.stderr.splitlines() if " error:" in line}) or [run.stderr]
