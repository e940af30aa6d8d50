// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "tests/fuzz/fuzz.hpp"

/// A parser with a defect of each kind that a slice is to find (slice_test.py): two letters, how many octets, the octets, their sum. The
/// environment says which defect it has. None of them shows with what the corpus has.
namespace {

using namespace hirosco;

[[nodiscard]] bool has(std::string_view defect) {
  const char* const planted = std::getenv("HIROSCO_PLANTED");
  return planted != nullptr && defect == planted;
}

[[nodiscard]] std::vector<std::byte> read(OctetReader& reader, Octets all) {
  const auto count = reader.get<std::uint8_t>();
  if (has("memory without bound") && count > 0x80) return std::vector<std::byte>(std::size_t{count} << 24);
  if (has("octets behind the end are read") && count > reader.remaining())
    return {all.data() + reader.position(), all.data() + reader.position() + count};
  while (has("no end") && count == 0) {
    volatile bool waits = true;
    static_cast<void>(waits);
  }
  if (has("something is thrown") && count > reader.remaining()) throw std::runtime_error{"too short"};
  const Octets octets = reader.get(count);
  return {octets.begin(), octets.end()};
}

[[nodiscard]] std::uint8_t sum_of(const std::vector<std::byte>& octets) {
  std::uint8_t sum = 0;
  for (const std::byte octet : octets) sum = static_cast<std::uint8_t>(sum + std::to_integer<unsigned>(octet));
  return sum;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Octets all = fuzz::octets_of(data, size);
  OctetReader reader{all};
  if (reader.get<std::uint16_t>() != 0x4846) return 0;
  const auto octets = read(reader, all);
  const auto sum = reader.get<std::uint8_t>();
  if (!reader.exhausted() || (sum != sum_of(octets) && !has("the sum is not looked at"))) return 0;
  fuzz::taken();
  fuzz::expect(sum == sum_of(octets), "what is taken has its sum");
  return 0;
}
