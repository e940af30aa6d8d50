#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What `tools/portable/build` says at its end is what ran, what was compiled only, and what was not built. Nothing is built here."""
import importlib.machinery
import importlib.util
import pathlib
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
LOADER = importlib.machinery.SourceFileLoader("portable_build", str(ROOT / "tools/portable/build"))
build = importlib.util.module_from_spec(importlib.util.spec_from_loader("portable_build", LOADER))
LOADER.exec_module(build)


def case(name, status, said):
    return f'<testcase name="{name}" status="{status}"><system-out>{said}</system-out></testcase>'


class Told(unittest.TestCase):
    def told(self, libraries, *cases):
        return list(build.told(libraries, f"<testsuite>{''.join(cases)}</testsuite>", "with musl", ["supervisor", "missions"]))

    def test_programs_that_ran_with_their_tests_and_libraries_that_were_compiled_only(self):
        lines = self.told(["utilities", "xml", "descriptor"], case("utilities_test", "run", "[  PASSED  ] 214 tests."), case("xml_test", "run", "[  PASSED  ] 1 test."))
        self.assertEqual(lines[0], "linked and run, with musl: utilities_test (214 tests), xml_test (1 tests)")
        self.assertTrue(lines[1].startswith("compiled only: hirosco_descriptor; "), lines)
        self.assertIn("left out as asked: resource, parameter, data_transfer, pus, subsystem", lines)
        self.assertEqual(lines[-1], "not built: supervisor, missions, which want Linux; so nothing flies with this backend")

    def test_what_failed_did_not_run(self):
        self.assertEqual(self.told(["xml"], case("xml_test", "fail", ""))[0], "linked and run, with musl: nothing")

    def test_all_that_stands_on_the_framework_is_named(self):
        self.assertEqual(set(build.folders_on_it()) & {"robotics", "simulation", "subsystems", "supervisor", "ground", "missions", "hirosco"},
                         {"robotics", "simulation", "subsystems", "supervisor", "ground", "missions"})


if __name__ == "__main__":
    unittest.main()
