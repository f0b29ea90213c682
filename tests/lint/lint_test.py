"""Shows that each lint check can fail: every test breaks one rule in a small made-up project."""

import pathlib
import tempfile
import unittest

import arrows
import formatting
import layout

TABLE = """
core/base -> 
core/motion -> core/base
core/motion/io -> core/motion core/base
server -> core/base
external torch/* : core/learning/*
"""


class MadeUpProject(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.write("tests/lint/arrows.txt", TABLE)
        self.write("core/README.md", "base/ motion/ motion/io/")

    def write(self, path, text):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)

    def assert_one(self, found, words):
        self.assertEqual(len(found), 1, found)
        self.assertIn(words, found[0])


class Arrows(MadeUpProject):
    def test_include_along_an_arrow_passes(self):
        self.write("core/motion/io/bvh.cc", '#include "core/motion/clip.h"\n')
        self.assertEqual(arrows.violations(self.root), [])

    def test_include_against_an_arrow_fails(self):
        self.write("core/base/status.cc", '#include "core/motion/clip.h"\n')
        self.assert_one(arrows.violations(self.root), "core/base may not include core/motion/clip.h")

    def test_a_layer_may_not_include_its_subfolder(self):
        self.write("core/motion/clip.cc", '#include "core/motion/io/bvh.h"\n')
        self.assert_one(arrows.violations(self.root), "core/motion may not include")

    def test_code_may_not_include_tests(self):
        self.write("server/main.cc", '#include "tests/support/data_files.h"\n')
        self.assert_one(arrows.violations(self.root), "server may not include")

    def test_library_outside_its_place_fails(self):
        self.write("server/main.cc", "#include <torch/torch.h>\n")
        self.assert_one(arrows.violations(self.root), "torch/torch.h may be included only in")

    def test_link_against_an_arrow_fails(self):
        self.write("core/base/CMakeLists.txt", "poise_library(poise_base DEPS poise_motion)")
        self.write("core/motion/CMakeLists.txt", "poise_library(poise_motion DEPS poise_base)")
        self.assert_one(arrows.violations(self.root), "poise_base may not link poise_motion")

    def test_line_without_an_arrow_is_an_error(self):
        self.assertRaises(ValueError, arrows.parse_table, "core/base core/math")


class Layout(MadeUpProject):
    def test_plain_header_passes(self):
        guard = "POISE_CORE_BASE_ISA_H_"
        self.write("core/base/isa.h", f"#ifndef {guard}\n#define {guard}\n#endif\n")
        self.assertEqual(layout.violations(self.root), [])

    def test_guard_of_another_path_fails(self):
        self.write("core/base/isa.h", "#ifndef ISA_H\n#define ISA_H\n#endif\n")
        self.assert_one(layout.violations(self.root), "POISE_CORE_BASE_ISA_H_")

    def test_vague_name_fails(self):
        self.write("core/base/string_utils.cc", "")
        self.assert_one(layout.violations(self.root), "says nothing")

    def test_name_that_only_contains_such_letters_passes(self):
        self.write("core/base/commonality.cc", "")
        self.assertEqual(layout.violations(self.root), [])

    def test_long_file_fails(self):
        self.write("core/base/isa.cc", "\n" * (layout.MAX_LINES + 1))
        self.assert_one(layout.violations(self.root), "401 lines")

    def test_left_over_note_fails(self):
        self.write("core/base/isa.cc", "// TODO: later\n")
        self.assert_one(layout.violations(self.root), "core/base/isa.cc:1")

    def test_folder_that_the_map_leaves_out_fails(self):
        self.write("core/push/wave.cc", "")
        self.assert_one(layout.violations(self.root), "does not mention core/push/")


class Formatting(MadeUpProject):
    def test_formatted_file_passes(self):
        self.write(".clang-format", "BasedOnStyle: Google\nColumnLimit: 100\n")
        self.write("core/base/isa.cc", "int x = 1;\n")
        self.assertEqual(formatting.violations(self.root), [])

    def test_file_that_clang_format_would_change_fails(self):
        self.write(".clang-format", "BasedOnStyle: Google\nColumnLimit: 100\n")
        self.write("core/base/isa.cc", "int  x=1;\n")
        self.assertIn("core/base/isa.cc:1", formatting.violations(self.root)[0])


if __name__ == "__main__":
    unittest.main()
