#!/usr/bin/python3
# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs a fuzz target on its corpus for a bounded time and writes a JUnit file.

Usage: run_fuzz_target.py PROGRAM CORPUS RESULT.xml [SECONDS]
"""

import pathlib
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ElementTree


def run(program, corpus, seconds):
    """Exit code and output; inputs found on the way are thrown away, those that fail are printed."""
    with tempfile.TemporaryDirectory() as found:
        command = [program, found, corpus, "-seed=1", f"-max_total_time={seconds}", "-max_len=600",
                   "-verbosity=0", f"-artifact_prefix={found}/"]
        result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                errors="replace", check=False)
    return result.returncode, result.stdout


def main(arguments):
    if len(arguments) not in (3, 4):
        sys.exit(__doc__)
    program, corpus, result_path = arguments[:3]
    seconds = arguments[3] if len(arguments) == 4 else "10"
    start = time.monotonic()
    code, output = run(program, corpus, seconds)
    print(output)
    name = pathlib.Path(program).name
    suite = ElementTree.Element("testsuite", name=name, tests="1", errors="0",
                                failures=str(int(code != 0)))
    case = ElementTree.SubElement(suite, "testcase", classname=name, name="finds_nothing",
                                  time=f"{time.monotonic() - start:.3f}")
    if code != 0:
        ElementTree.SubElement(case, "failure", message=f"exit code {code}").text = output[-4000:]
    pathlib.Path(result_path).parent.mkdir(parents=True, exist_ok=True)
    ElementTree.ElementTree(suite).write(result_path, encoding="utf-8", xml_declaration=True)
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
