#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What `tools/portable/build` says at its end is what ran, what was compiled only, and what was not built. Nothing is built here."""
import importlib.machinery
import importlib.util
import pathlib
import struct
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
LOADER = importlib.machinery.SourceFileLoader("portable_build", str(ROOT / "tools/portable/build"))
build = importlib.util.module_from_spec(importlib.util.spec_from_loader("portable_build", LOADER))
LOADER.exec_module(build)


def case(name, status, said):
    return f'<testcase name="{name}" status="{status}"><system-out>{said}</system-out></testcase>'


def program(wide, order, kinds):
    """The headers of an ELF file, and no more: `kinds` of its segments."""
    head = b"\x7fELF" + bytes([2 if wide else 1, 1 if order == "<" else 2]) + bytes(10)
    first, size, entry = (64, 64, 56) if wide else (52, 52, 32)
    head += struct.pack(order + ("HHIQQQIHHHHHH" if wide else "HHIIIIIHHHHHH"), 2, 62, 1, 0, first, 0, 0, size, entry, len(kinds), 0, 0, 0)
    return head + b"".join(struct.pack(order + "I", kind).ljust(entry, b"\0") for kind in kinds)


class Told(unittest.TestCase):
    def told(self, libraries, *cases):
        return list(build.told(libraries, f"<testsuite>{''.join(cases)}</testsuite>", "with musl", ["supervisor", "missions"]))

    def test_programs_that_ran_with_their_tests_and_libraries_that_were_compiled_only(self):
        lines = self.told(["utilities", "xml", "descriptor"], case("utilities_test", "run", "[  PASSED  ] 214 tests."), case("xml_test", "run", "[  PASSED  ] 1 test."))
        self.assertEqual(lines[0], "linked and run, with musl: utilities_test (214 tests), xml_test (1 tests)")
        self.assertTrue(lines[1].startswith("compiled only: hirosco_descriptor; "), lines)
        self.assertIn("left out as asked: resource, parameter, data_transfer, pus, subsystem", lines)
        self.assertEqual(lines[-1], "not built: supervisor, missions, which want Linux; so nothing flies with this backend")

    def test_what_failed_or_tried_nothing_or_is_not_there_did_not_run_and_is_named(self):
        for said in (case("xml_test", "fail", ""), case("xml_test", "run", "[  PASSED  ] 0 tests."), ""):
            lines = self.told(["xml", "subsystem"], said)
            self.assertEqual(lines[0], "linked and run, with musl: nothing")
            self.assertTrue(lines[1].startswith("asked for, and no test of it ran: xml_test;"), lines)
            self.assertEqual(build.not_run(["xml", "subsystem"], f"<testsuite>{said}</testsuite>"), ["xml_test"])

    def test_a_program_that_names_a_loader_is_not_linked_statically(self):
        for wide, order in ((True, "<"), (False, "<"), (True, ">"), (False, ">")):
            for kinds in ((1, 3), (1, 2)):
                self.assertEqual(build.wants_loader(program(wide, order, kinds)), 3 in kinds, (wide, order, kinds))

    def test_all_that_stands_on_the_framework_is_named(self):
        self.assertEqual(set(build.folders_on_it()) & {"robotics", "simulation", "subsystems", "supervisor", "ground", "missions", "hirosco"},
                         {"robotics", "simulation", "subsystems", "supervisor", "ground", "missions"})


if __name__ == "__main__":
    unittest.main()
