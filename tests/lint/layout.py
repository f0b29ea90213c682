"""Checks names, file lengths, header guards, left-over notes, and the list in core/README.md."""

import re

from files import project_files

CODE = (".h", ".cc", ".py", ".proto")
VAGUE_NAME = re.compile(r"(^|_)(utils?|helpers?|misc|common)(_|\.|$)")
LEFT_OVER = re.compile(r"\b(TODO|FIXME|XXX)\b")
MAX_LINES = 400


def guard_of(path):
    """core/base/isa.h -> POISE_CORE_BASE_ISA_H_."""
    return "POISE_" + re.sub(r"[^A-Za-z0-9]", "_", str(path)).upper() + "_"


def guard_violations(path, text):
    guard = guard_of(path)
    if f"#ifndef {guard}\n#define {guard}\n" not in text:
        return [f"{path}:1: the header guard should be {guard}"]
    return []


def file_violations(path, text):
    found = []
    if any(VAGUE_NAME.search(part) for part in path.parts):
        found.append(f"{path}: the name says nothing (utils, helper, misc, common)")
    lines = text.splitlines()
    if len(lines) > MAX_LINES:
        found.append(f"{path}: {len(lines)} lines, at most {MAX_LINES}: split it")
    if path.parts[:2] != ("tests", "lint"):
        for number, line in enumerate(lines, 1):
            if LEFT_OVER.search(line):
                found.append(f"{path}:{number}: a left-over note; do it or file an issue")
    if path.suffix == ".h":
        found += guard_violations(path, text)
    return found


def readme_violations(root):
    """core/README.md is the map of core/: every folder with code has its place there."""
    readme = (root / "core/README.md").read_text()
    folders = {str(p.parent) for p in project_files(root, (".h", ".cc")) if p.parts[0] == "core"}
    missing = [f for f in sorted(folders) if f"{f.removeprefix('core/')}/" not in readme]
    return [f"core/README.md: does not mention {folder}/" for folder in missing]


def violations(root):
    found = readme_violations(root)
    for path in project_files(root, CODE):
        found += file_violations(path, (root / path).read_text(encoding="utf-8"))
    return found
