#!/usr/bin/python3
# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the structure tests and writes a JUnit file. Usage: run.py RESULT.xml [NAME=VALUE ...]"""

import os
import pathlib
import sys
import time
import unittest
import xml.etree.ElementTree as ElementTree

SUITE = "structure"


class JUnitResult(unittest.TextTestResult):
    """Keeps an element for every test beside the text on the terminal."""

    def __init__(self, *args, **kwargs):
        super().__init__(*args, **kwargs)
        self.suite = ElementTree.Element("testsuite", name=SUITE)

    def startTest(self, test):
        super().startTest(test)
        self._started = time.monotonic()
        name = test.id().rsplit(".", 2)
        self._case = ElementTree.SubElement(self.suite, "testcase", classname=name[-2], name=name[-1])

    def stopTest(self, test):
        self._case.set("time", f"{time.monotonic() - self._started:.3f}")
        super().stopTest(test)

    def _add(self, tag, text):
        ElementTree.SubElement(self._case, tag, message=text).text = text

    def addFailure(self, test, err):
        super().addFailure(test, err)
        self._add("failure", str(err[1]))

    def addError(self, test, err):
        super().addError(test, err)
        # An error outside any test (a module that cannot be imported) has no element yet.
        if not hasattr(self, "_case"):
            self._case = ElementTree.SubElement(
                self.suite, "testcase", classname=SUITE, name=str(test))
        self._add("error", f"{err[0].__name__}: {err[1]}")

    def addSubTest(self, test, subtest, err):
        super().addSubTest(test, subtest, err)
        if err is not None:
            self._add("failure", f"{subtest._subDescription()}: {err[1]}")

    def addSkip(self, test, reason):
        super().addSkip(test, reason)
        self._add("skipped", reason)

    def write(self, path):
        self.suite.set("tests", str(self.testsRun))
        self.suite.set("failures", str(len(self.failures)))
        self.suite.set("errors", str(len(self.errors)))
        path.parent.mkdir(parents=True, exist_ok=True)
        ElementTree.ElementTree(self.suite).write(path, encoding="utf-8", xml_declaration=True)


def main(arguments):
    if not arguments:
        sys.exit(__doc__)
    os.environ.update(argument.split("=", 1) for argument in arguments[1:])
    here = pathlib.Path(__file__).resolve().parent
    sys.dont_write_bytecode = True
    tests = unittest.defaultTestLoader.discover(str(here), pattern="test_*.py", top_level_dir=str(here))
    result = unittest.TextTestRunner(verbosity=2, resultclass=JUnitResult).run(tests)
    result.write(pathlib.Path(arguments[0]))
    return 0 if result.wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
