#!/usr/bin/env python3
"""Counts test cases in JUnit XML files, each once. Last line: N passed, M failed; exit code 1 on a failure or no case."""
import argparse
import pathlib
import sys
import xml.etree.ElementTree as ElementTree


def outcomes(path):
    """(class, name) -> failed, of every case in a file; an unreadable file is a failed case of its own."""
    try:
        root = ElementTree.parse(path).getroot()
    except ElementTree.ParseError as error:
        return {(str(path), f"unreadable: {error}"): True}
    cases = {}
    for case in root.iter("testcase"):
        if case.get("status") == "notrun" or case.find("skipped") is not None:
            continue
        failed = case.find("failure") is not None or case.find("error") is not None
        key = (case.get("classname", ""), case.get("name", ""))
        cases[key] = cases.get(key, False) or failed
    return cases


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", type=pathlib.Path)
    parser.add_argument("--ctest-status", type=int, default=0, help="exit code of ctest")
    arguments = parser.parse_args()

    passed, failed = 0, []
    wrappers = []
    for path in sorted(arguments.directory.rglob("*.xml")):
        if path.name.startswith("rostest-"):
            wrappers.append(path)
            continue
        for (owner, name), broken in outcomes(path).items():
            if broken:
                failed.append(f"{path.stem}: {owner}.{name}")
            else:
                passed += 1
    # rostest-*.xml repeats what rosunit-*.xml says; only a failure of the wrapper alone is news.
    known = {entry.rsplit(".", 1)[-1] for entry in failed}
    for path in wrappers:
        for (owner, name), broken in outcomes(path).items():
            if broken and name.rsplit(".", 1)[-1] not in known:
                failed.append(f"{path.stem}: {owner}.{name}")
    if arguments.ctest_status != 0 and not failed:
        failed.append(f"ctest: exit code {arguments.ctest_status} without a failed case")
    for entry in failed:
        print(f"failed: {entry}")
    if passed == 0 and not failed:
        print(f"no test ran: no results under {arguments.directory}")
    print(f"{passed} passed, {len(failed)} failed")
    return 1 if failed or passed == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
