// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <span>
#include <string>
#include <string_view>

#include "hirosco/utilities/crc32.hpp"
#include "supervisor/platform/storage/ascii_database.hpp"
#include "tests/fuzz/fuzz.hpp"

/// A line of a log as text, of a record or with the version, and a time as people write it, from whatever text comes: what is taken is written and read the same, and can be shown.
namespace {

using namespace hirosco;
using namespace hirosco::supervisor;
using fuzz::expect;

void check_line(std::string_view line) {
  const auto record = record_from_ascii(line);
  if (!record) return;
  fuzz::taken();
  const auto again = record_from_ascii(ascii_line(*record));
  expect(again && *again == *record, "a record is written and read the same");
  expect(!describe(*record).empty(), "a record can be shown");
}

void check_version(std::string_view line) {
  const auto version = version_from_ascii(line);
  if (!version) return;
  fuzz::taken();
  expect(version_from_ascii(ascii_version_line(*version)) == version, "a version is written and read the same");
  expect(!record_from_ascii(line), "a line says a version or a record");
}

void check_time(std::string_view text) {
  const auto time = time_from_text(text);
  if (!time) return;
  fuzz::taken();
  const auto again = time_from_text(time_text(*time));
  expect(again && *again == *time, "a time is written and read the same");
}

}  // namespace

/// As it is, and with the check sum that it has, so that this hides nothing.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::text_of(data, size);
  check_time(text);
  check_line(text);
  check_version(text);
  std::array<char, 16> sum{};
  std::snprintf(sum.data(), sum.size(), " #%08x", static_cast<unsigned>(crc32(std::as_bytes(std::span{text}))));
  check_line(std::string{text} + sum.data());
  check_version(std::string{text} + sum.data());
  return 0;
}
