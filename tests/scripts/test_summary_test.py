"""The last line of scripts/test must not hide a failure, nor call a missing program skipped."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

SUMMARY = pathlib.Path(__file__).parents[2] / "scripts/test_summary.py"
PASSED = '<testcase name="Walks" status="run"/>'
FAILED = '<testcase name="Falls" status="fail"><failure message=""/></testcase>'
NOT_BUILT = ('<testcase name="Absent" status="notrun">'
             '<skipped message="Unable to find executable"/></testcase>')
DISABLED = '<testcase name="Serves" status="disabled"/>'
WITHOUT_DATA = ('<testcase name="Reads" status="notrun">'
                '<skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/>'
                "<system-out>needs real data: hdm05 does not exist</system-out></testcase>")


def summarise(cases, *options):
    with tempfile.TemporaryDirectory() as folder:
        results = pathlib.Path(folder) / "results.xml"
        results.write_text(f"<testsuite>{''.join(cases)}</testsuite>")
        run = subprocess.run([sys.executable, SUMMARY, results, *options],
                             capture_output=True, text=True, check=False)
        return run.returncode, run.stdout.splitlines()


class TestSummary(unittest.TestCase):
    def test_ends_with_the_plain_line(self):
        self.assertEqual(summarise([PASSED, PASSED]), (0, ["2 passed, 0 failed, 0 skipped"]))

    def test_names_what_failed(self):
        self.assertEqual(summarise([PASSED, FAILED]),
                         (1, ["failed: Falls", "1 passed, 1 failed, 0 skipped"]))

    def test_a_program_that_is_missing_failed(self):
        code, lines = summarise([PASSED, NOT_BUILT])
        self.assertEqual((code, lines[-1]), (1, "1 passed, 1 failed, 0 skipped"))

    def test_a_disabled_one_counts_as_nothing(self):
        self.assertEqual(summarise([PASSED, DISABLED]), (0, ["1 passed, 0 failed, 0 skipped"]))

    def test_skipped_for_want_of_data_passes_unless_data_is_required(self):
        self.assertEqual(summarise([WITHOUT_DATA])[0], 0)
        code, lines = summarise([WITHOUT_DATA], "--require-data")
        self.assertEqual((code, lines[-1]), (1, "0 passed, 0 failed, 1 skipped"))


if __name__ == "__main__":
    unittest.main()
