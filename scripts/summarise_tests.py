#!/usr/bin/python3
# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
"""Counts the tests in a folder of JUnit files: prints `N passed, N failed` and what failed, how.

Exits 0 when at least one test ran and none failed, else 1.
"""

import pathlib
import sys
import xml.etree.ElementTree as ElementTree


OUTPUT_LINES = 20  # of a failed test that are printed


def printed(case):
    """What a test printed: the failures of its assertions and, last, how it ended."""
    lines = (case.findtext("system-out") or "").splitlines()
    first = next((i for i, line in enumerate(lines) if "Failure" in line or "ERROR:" in line), None)
    shown = lines[-OUTPUT_LINES:] if first is None else lines[first:][:OUTPUT_LINES]
    return "".join(f"\n    {line}" for line in shown)


def outcome(case):
    """None for a test that passed, else the first line of what it says and what it printed."""
    for child in case:
        if child.tag in ("failure", "error"):
            text = child.get("message") or child.text or child.tag
            first = text.strip().splitlines()[0] if text.strip() else child.tag
            return first + printed(case)
    if case.get("status") in ("fail", "failed", "notrun_failed"):
        return "failed" + printed(case)
    return None


def was_run(case):
    skipped = case.find("skipped") is not None or case.get("status") in ("notrun", "disabled")
    return not skipped


def main(folder):
    passed = 0
    failed = []
    for path in sorted(pathlib.Path(folder).rglob("*.xml")):
        try:
            cases = list(ElementTree.parse(path).iter("testcase"))
        except ElementTree.ParseError as error:
            failed.append((path.stem, f"no readable result: {error}"))
            continue
        for case in filter(was_run, cases):
            reason = outcome(case)
            if reason is None:
                passed += 1
            else:
                failed.append((f"{path.stem}: {case.get('classname')}.{case.get('name')}", reason))
    for name, reason in failed:
        print(f"FAILED {name}: {reason}")
    print(f"{passed} passed, {len(failed)} failed")
    return 0 if passed and not failed else 1


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: summarise_tests.py FOLDER")
    sys.exit(main(sys.argv[1]))
