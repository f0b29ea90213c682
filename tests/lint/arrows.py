"""Checks #include lines and CMake DEPS lists against the table arrows.txt."""

import dataclasses
import fnmatch
import re

from files import project_files

INCLUDE = re.compile(r'^\s*#\s*include\s+[<"]([^>"]+)[>"]')
LIBRARY = re.compile(r"poise_(?:library|program)\(\s*(\w+)(.*?)\)", re.DOTALL)
KEYWORDS = {"SOURCES", "DEPS", "PRIVATE_DEPS", "TORCH"}
# core/motion and its subfolders are layers of their own.
NOT_RECURSIVE = {"core/motion"}


@dataclasses.dataclass
class Table:
    """allowed: folder -> folders it may include; external: [(name patterns, place patterns)]."""

    allowed: dict
    external: list


def parse_table(text):
    table = Table({}, [])
    for number, line in enumerate(text.splitlines(), 1):
        line = line.split("#")[0].strip()
        if not line:
            continue
        if line.startswith("external ") and ":" in line:
            names, places = line.removeprefix("external ").split(":")
            table.external.append((names.split(), places.split()))
        elif "->" in line:
            folder, right = line.split("->")
            table.allowed[folder.strip()] = right.split()
        else:
            raise ValueError(f"arrows.txt:{number}: expected 'FOLDER -> FOLDER...'")
    return table


def owner(path, table):
    """The folder of the table that speaks for this path, or None."""
    for parent in path.parents:
        if str(parent) in table.allowed:
            return str(parent)
    return None


def folder_covers(folder, other):
    if other == folder:
        return True
    return folder not in NOT_RECURSIVE and other.startswith(folder + "/")


def may_use(user, used, table):
    return any(folder_covers(folder, used) for folder in [user, *table.allowed[user]])


def include_violations(root, table):
    """Every #include of the project's own headers, and of libraries that are kept in one place."""
    found = []
    for path in project_files(root, (".h", ".cc")):
        user = owner(path, table)
        for number, line in enumerate((root / path).read_text().splitlines(), 1):
            match = INCLUDE.match(line)
            if not match:
                continue
            name = match.group(1)
            for names, places in table.external:
                if (any(fnmatch.fnmatch(name, p) for p in names)
                        and not any(fnmatch.fnmatch(str(path), p) for p in places)):
                    found.append(f"{path}:{number}: {name} may be included only in "
                                 + " ".join(places))
            used = owner(path.__class__(name), table)
            if user and used and not may_use(user, used, table):
                found.append(f"{path}:{number}: {user} may not include {name}")
            if user and name.startswith(("tests/", "bench/")):
                found.append(f"{path}:{number}: {user} may not include {name}")
    return found


def libraries(root):
    """[(target, folder, direct dependencies)] of the poise_library and poise_program calls."""
    result = []
    for path in project_files(root, ("CMakeLists.txt",)):
        text = re.sub(r"#.*", "", (root / path).read_text())
        for target, body in LIBRARY.findall(text):
            words, dependencies, keyword = body.split(), [], None
            for word in words:
                if word in KEYWORDS:
                    keyword = word
                elif keyword in ("DEPS", "PRIVATE_DEPS"):
                    dependencies.append(word)
            result.append((target, path.parent, dependencies))
    return result


def dependency_violations(root, table):
    """Every target that a target links, by the folders in which the two are defined."""
    found, all_libraries = [], libraries(root)
    folder_of = {target: folder for target, folder, _ in all_libraries}
    for target, folder, dependencies in all_libraries:
        user = owner(folder / "CMakeLists.txt", table)
        for dependency in dependencies:
            used = (owner(folder_of[dependency] / "CMakeLists.txt", table)
                    if dependency in folder_of else None)
            if user and used and not may_use(user, used, table):
                found.append(f"{folder}/CMakeLists.txt: {target} may not link {dependency} ({used})")
    return found


def violations(root):
    table = parse_table((root / "tests/lint/arrows.txt").read_text())
    return include_violations(root, table) + dependency_violations(root, table)
