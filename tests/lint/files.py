"""Which files the lint tests look at: what git tracks or would track."""

import pathlib
import subprocess

GENERATED = {"build", "node_modules", "runs", "demo-out", ".git"}


def project_files(root, suffixes):
    """Paths below root (relative, sorted) that end in one of the suffixes, without ignored ones."""
    listed = subprocess.run(
        ["git", "-C", str(root), "ls-files", "--cached", "--others", "--exclude-standard"],
        capture_output=True, text=True, check=False) if (root / ".git").exists() else None
    if listed is not None and listed.returncode == 0:
        paths = [pathlib.PurePosixPath(line) for line in listed.stdout.splitlines()]
    else:
        paths = [pathlib.PurePosixPath(p.relative_to(root).as_posix()) for p in root.rglob("*")]
        paths = [p for p in paths if not GENERATED.intersection(p.parts)]
    return sorted(p for p in paths if p.name.endswith(tuple(suffixes)) and (root / p).is_file())
