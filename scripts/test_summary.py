"""Counts ctest's JUnit results; optionally refuses tests that were skipped for want of data."""

import argparse
import sys
import xml.etree.ElementTree as ElementTree

# What POISE_REQUIRE_DATA (tests/support/data_files.h) writes.
MISSING_DATA = "needs real data"


def classify(case):
    """passed, failed, skipped or disabled (the second process of some other test).

    A program that is missing did not skip its tests: it failed.
    """
    if case.get("status") in ("run", "disabled"):
        return {"run": "passed", "disabled": "disabled"}[case.get("status")]
    skipped = case.find("skipped")
    if skipped is not None and skipped.get("message", "").startswith("SKIP_"):
        return "skipped"
    return "failed"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", help="JUnit file that ctest wrote")
    parser.add_argument("--require-data", action="store_true",
                        help="fail when a test was skipped for want of real data")
    arguments = parser.parse_args()

    counts = {"passed": 0, "failed": 0, "skipped": 0}
    without_data = []
    for case in ElementTree.parse(arguments.results).getroot().iter("testcase"):
        outcome = classify(case)
        if outcome == "disabled":
            continue
        counts[outcome] += 1
        if outcome == "failed":
            print(f"failed: {case.get('name')}")
        if outcome == "skipped":
            output = case.findtext("system-out") or ""
            if MISSING_DATA in output:
                without_data.append(case.get("name"))
            print(f"skipped: {case.get('name')}")
    refused = arguments.require_data and without_data
    if refused:
        print(f"{len(without_data)} skipped for want of real data, which --require-data forbids")
    print("{passed} passed, {failed} failed, {skipped} skipped".format(**counts))
    return 1 if refused or counts["failed"] else 0


if __name__ == "__main__":
    sys.exit(main())
