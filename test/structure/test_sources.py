# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
"""Licence lines, file sizes and format."""

import shutil
import subprocess
import unittest

from layout import ROOT, files, relative

COPYRIGHT = "Copyright (c) 2026, the planecloud_slam authors"
LICENCE = "SPDX-License-Identifier: BSD-3-Clause"
MAX_LINES = 300
MAX_TEST_LINES = 500


def line_count(path):
    return len(path.read_text(encoding="utf-8").splitlines())


class Sources(unittest.TestCase):
    def test_every_file_begins_with_its_licence(self):
        paths = files("*.h", "*.cpp", "*.py", "*.sh", "*.cmake", "CMakeLists.txt", "*.msg", "*.srv",
                      "*.launch", "*.test", "*.yaml", "*.xml")
        paths += [ROOT / name for name in ("CMakeLists.txt", "package.xml", "scripts/demo",
                                           "scripts/test", ".ci/run")]
        missing = []
        for path in paths:
            head = path.read_text(encoding="utf-8")[:400]
            if COPYRIGHT not in head or LICENCE not in head:
                missing.append(relative(path))
        self.assertEqual([], missing)

    def test_no_file_is_too_long_to_read(self):
        def limit(path):
            return MAX_TEST_LINES if relative(path).startswith("test/") else MAX_LINES

        long = [f"{relative(path)}: {line_count(path)} lines"
                for path in files("*.h", "*.cpp", "*.py", "*.sh") if line_count(path) > limit(path)]
        self.assertEqual([], long)

    def test_sources_are_formatted(self):
        tool = shutil.which("clang-format-14") or shutil.which("clang-format")
        if tool is None:
            self.skipTest("clang-format is not installed")
        sources = [str(path) for path in files("*.h", "*.cpp")]
        check = subprocess.run([tool, "--dry-run", *sources], cwd=ROOT, text=True,
                               capture_output=True, check=False)
        wrong = {line.split(":")[0] for line in check.stderr.splitlines() if "warning:" in line}
        self.assertEqual([], sorted(wrong), "run clang-format -i on them")


if __name__ == "__main__":
    unittest.main()
