// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>
#include <vector>

#include "hirosco/utilities/crc32.hpp"
#include "supervisor/platform/storage/value_copy.hpp"
#include "supervisor/supervision/data_handling/persistent_values/value_set.hpp"
#include "tests/fuzz/fuzz.hpp"

/// Values of persistent parameters as they stand on a disk, from whatever octets come: a copy that is taken is the octets that it came from, its
/// values are within their ranges, all or none of them are in force, and what begins with them is of their layout.
namespace {

using namespace hirosco;
using namespace hirosco::supervisor;
using fuzz::expect;

[[nodiscard]] descriptor::Field field(const char* name, Type type, std::uint32_t count = 1) {
  descriptor::Field made;
  made.name = name;
  made.type = type;
  made.count = count;
  return made;
}

[[nodiscard]] descriptor::Parameter kept(std::uint8_t id, descriptor::Field of) {
  descriptor::Parameter made;
  made.field = std::move(of);
  made.id = id;
  made.persistent = true;
  return made;
}

/// Numbers with a range, a switch, words, and a structure.
[[nodiscard]] descriptor::MissionSubsystem lamp() {
  descriptor::MissionSubsystem made;
  made.subsystem.name = "LAMP";
  made.subsystem.id = 10;
  descriptor::Field level = field("LEVEL", Type::Double, 2), words = field("TITLE", Type::Text);
  level.minimum = Number{-1};
  level.maximum = Number{0.5};
  words.text_octets = 6;
  descriptor::Parameter gains = kept(4, field("GAINS", Type::Struct));
  gains.members = {{field("P", Type::Float), 1}, {field("ON", Type::Bool), 2}};
  made.subsystem.parameters = {kept(1, level), kept(2, words), kept(3, field("SHUTTERS", Type::Bool, 2)), gains,
                               kept(5, field("COUNT", Type::Uint16))};
  return made;
}

/// Of values that were taken.
void check_in_force(const ValueSet& set) {
  fuzz::taken();
  ValueSet next{lamp()};
  expect(next.take({.layout = set.layout(), .sequence = 1, .since = {}, .values = set.octets()}).has_value(),
         "values that are in force can be kept");
  expect(next.octets() == set.octets() && next.size() == set.size(), "values are kept as they are");
  auto member = lamp();
  set.begin(member);
  expect(ValueSet{member}.layout() == set.layout(), "what begins with them has their layout");
}

void check_values(Octets octets) {
  ValueSet set{lamp()};
  const ValueCopy copy{.layout = set.layout(), .sequence = 1, .since = {}, .values = {octets.begin(), octets.end()}};
  const auto before = set.octets();
  if (set.take(copy)) check_in_force(set);
  else expect(set.octets() == before, "of values that are refused none is in force");
}

void check_copy(Octets octets) {
  const auto copy = read_copy(octets);
  if (!copy) return expect(copy.error() == CopyFault::Damaged || copy.error() == CopyFault::Version, "why not is told");
  fuzz::taken();
  expect(std::ranges::equal(write_copy(*copy), octets), "a copy is the octets that it came from");
  ValueSet set{lamp()};
  if (set.take(*copy)) check_in_force(set);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Octets octets = fuzz::octets_of(data, size);
  check_copy(octets);
  check_values(octets);
  // With the check sum that these octets have, so that it hides nothing; and as the values of a copy.
  std::vector<std::byte> sealed(octets.size() + sizeof(std::uint32_t));
  OctetWriter{sealed}.put(octets).put(crc32(octets));
  check_copy(sealed);
  check_copy(write_copy(
      {.layout = ValueSet{lamp()}.layout(), .sequence = 7, .since = {}, .values = {octets.begin(), octets.end()}}));
  return 0;
}
