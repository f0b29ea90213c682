"""Runs one lint check on the project: lint.py arrows|layout|formatting ROOT."""

import importlib
import pathlib
import sys

CHECKS = ("arrows", "layout", "formatting")


def main():
    if len(sys.argv) != 3 or sys.argv[1] not in CHECKS:
        print(f"usage: lint.py {'|'.join(CHECKS)} ROOT", file=sys.stderr)
        return 2
    found = importlib.import_module(sys.argv[1]).violations(pathlib.Path(sys.argv[2]))
    for violation in found:
        print(violation)
    print(f"{sys.argv[1]}: {len(found)} violations")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
