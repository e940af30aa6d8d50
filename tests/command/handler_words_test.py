#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What a newcomer writes by mistake as a handler is told in words, by the compiler and first of all."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEADER = '#include "hirosco/subsystem/author/custom_service.hpp"\n'
AUTHOR = """
using namespace hirosco;
struct Author : Subsystem {
  CustomService book{"BOOK"};
  Result<Step> software_init() override { %s; return done; }
};
"""
COMPILER = sys.argv.pop(1) if len(sys.argv) > 1 and not sys.argv[1].startswith("-") else "c++"


class Handlers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        (cls.folder / "author.hpp").write_text(HEADER)
        # The header compiled once: by itself it is what each of these takes longest for.
        cls.told_by_compiler("-x", "c++-header", "author.hpp", "-o", "author.hpp.gch")

    @classmethod
    def told_by_compiler(cls, *arguments):
        return subprocess.run([COMPILER, "-std=c++23", f"-I{ROOT}", *arguments], cwd=cls.folder, capture_output=True, text=True,
                              check=False, env={"LC_ALL": "C", "PATH": "/usr/bin:/bin:/usr/local/bin"}).stderr

    def first_error(self, handler):
        (self.folder / "author.cpp").write_text(AUTHOR % handler)
        told = self.told_by_compiler("-fsyntax-only", "-include", "author.hpp", "author.cpp")
        return next((line for line in told.splitlines() if "error:" in line), "")

    def test_good_ones_compile(self):
        good = ('on_function("X", [](double, std::uint8_t) -> Result<> { return ok(); })',
                'on_function("X", [](const FunctionValues&, Call) -> Outcome { return running; })',
                'on_function("X", [](std::int64_t, std::string_view, const std::array<bool, 3>&, Sized<float, 4>, Call)'
                ' -> Outcome { return running; })',
                'book.on_request("X", [](std::uint16_t, std::string_view, bool, const Call&) -> Outcome { return running; })')
        self.assertEqual(self.first_error(";\n".join(good)), "")

    def test_one_that_returns_nothing_is_told_what_to_return(self):
        for handler in ('on_function("X", [](double) {})', 'book.on_request("X", [](const std::uint16_t&) {})'):
            self.assertIn("a handler returns Result<> or Outcome: write '-> Result<>'", self.first_error(handler))

    def test_one_with_arguments_that_no_call_brings_is_told_which_it_may_have(self):
        self.assertIn("a handler takes numbers or enumerations", self.first_error(
            'on_function("X", [](const char*) -> Result<> { return ok(); })'))
        self.assertIn("or FunctionValues, and last a Call", self.first_error(
            'on_function("X", [](const std::vector<double>&) -> Result<> { return ok(); })'))

    def test_one_that_takes_a_string_is_told_that_text_does_not_allocate(self):
        self.assertIn("text comes as std::string_view", self.first_error(
            'on_function("X", [](const std::string&) -> Result<> { return ok(); })'))

    def test_one_that_is_noexcept_is_a_handler(self):
        good = ('on_function("X", [](double) noexcept -> Result<> { return ok(); })',
                'on_function("X", [](const FunctionValues&, Call) noexcept -> Outcome { return running; })',
                'book.on_request("X", [](const std::uint16_t&) noexcept -> Result<> { return ok(); })')
        self.assertEqual(self.first_error(";\n".join(good)), "")
        self.assertIn("a handler returns Result<> or Outcome", self.first_error('on_function("X", [](double) noexcept {})'))

    def test_one_that_would_give_an_argument_back_is_told_that_nobody_takes_it(self):
        for argument in ("double&", "Sized<float, 4>&", "std::uint16_t&&"):
            self.assertIn("a handler takes its arguments by value or as const&", self.first_error(
                f'on_function("X", []({argument}) -> Result<> {{ return ok(); }})'))

    def test_one_whose_call_is_not_the_last_is_told_where_it_belongs(self):
        for arguments in ("Call, double", "double, Call, bool", "Call, const FunctionValues&", "Call, Call"):
            self.assertIn("a handler takes one Call at most, behind all arguments", self.first_error(
                f'on_function("X", []({arguments}) -> Outcome {{ return running; }})'))

    def test_one_that_changes_itself_or_takes_anything_is_told_what_a_handler_is(self):
        for handler in ('on_function("X", [n = 0](double) mutable -> Result<> { ++n; return ok(); })',
                        'on_function("X", [](auto) -> Result<> { return ok(); })'):
            self.assertIn("a handler is a lambda with arguments of definite types", self.first_error(handler))


if __name__ == "__main__":
    unittest.main(verbosity=2)
