#!/usr/bin/python3
"""Sums up JUnit reports of ctest: each skipped test with its reason, each failed one, the count.

Usage: summarise_tests.py [--failed=STEP].. REPORT.xml..

A step that failed outside of the tests (a build, lint) counts as one failure, and so does a
report that is missing. Exit status 1 if anything failed.
"""
import argparse
import pathlib
import sys
import xml.etree.ElementTree as ElementTree


def skip_reason(case):
    """The text that GTEST_SKIP() streamed: the lines between its file:line and the result."""
    lines = [line.strip() for line in (case.findtext("system-out") or "").splitlines()]
    reason = []
    for line in lines:
        if line.endswith(": Skipped"):
            reason = []
        elif line.startswith("[  SKIPPED ]"):
            break
        else:
            reason.append(line)
    text = " ".join(part for part in reason if part)
    return text or "no reason given"


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--failed", action="append", default=[])
    parser.add_argument("reports", nargs="*", type=pathlib.Path)
    arguments = parser.parse_args()

    passed, failed, skipped = 0, list(arguments.failed), []
    for report in arguments.reports:
        preset = report.parent.name
        if not report.is_file():
            failed.append(f"{preset}: no test report")
            continue
        for case in ElementTree.parse(report).getroot().iter("testcase"):
            name = f"{preset}: {case.get('name')}"
            if case.find("skipped") is not None:
                skipped.append(f"{name}: {skip_reason(case)}")
            elif case.get("status") == "run":
                passed += 1
            else:
                failed.append(name)

    for line in skipped:
        print(f"skipped  {line}")
    for line in failed:
        print(f"FAILED   {line}")
    print(f"{passed} passed, {len(failed)} failed, {len(skipped)} skipped")
    return 1 if failed else 0


sys.exit(main())
