// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <vector>

#include "hirosco/subsystem/pages/page_words.hpp"
#include "tests/fuzz/fuzz.hpp"

/// The words by which the pages of a member get across a stream, from whatever octets come: what is taken is told as it came, what is refused changes
/// nothing, and actuators may move by the one permission of their epoch only, and by none after the stream has ended.
namespace {

using namespace hirosco;
using fuzz::expect;

[[nodiscard]] std::vector<std::byte> told_by(StreamWords& words) {
  std::array<std::byte, StreamWords::max_octets> room;
  OctetWriter writer{room};
  words.tell(writer);
  expect(writer.good() && writer.size() >= words.urgent_octets(), "words have room");
  return {writer.written().begin(), writer.written().end()};
}

void check_permit(Octets octets) {
  const VitalPage vital{};
  VitalPage unused;
  PermitPage copy;
  MemberWords member{vital, copy};
  SupervisorWords as_it_is{unused, copy};
  const auto before = told_by(as_it_is);
  if (!member.hear(octets)) {
    expect(told_by(as_it_is) == before, "what is refused changes no permission");
    return;
  }
  fuzz::taken();
  const std::uint32_t epoch = copy.epoch.load();
  // No permit page has epoch 0: it counts from 1.
  if (epoch != 0) expect(std::ranges::equal(told_by(as_it_is), octets), "permit words are told as they came");
  const bool permits = copy.go.load() == permission_word(epoch);
  expect(copy.permits(epoch) == permits, "a permission is that of its epoch");
  member.shut();
  expect(!copy.permits(epoch), "whoever cannot be asked permits nothing");
  expect(member.hear(octets) && !copy.permits(epoch), "and nothing under the same epoch again");
}

void check_vital(Octets octets) {
  const PermitPage permit{};
  PermitPage unused;
  VitalPage copy;
  SupervisorWords supervisor{copy, permit};
  MemberWords as_it_is{copy, unused};
  const auto before = told_by(as_it_is);
  if (!supervisor.hear(octets)) {
    expect(told_by(as_it_is) == before, "what is refused changes nothing that a member is said to do");
    return;
  }
  fuzz::taken();
  // Links that are none, behind the last one, are not told again.
  const auto words = told_by(as_it_is);
  expect(words.size() <= octets.size() && supervisor.hear(words) && told_by(as_it_is) == words,
         "vital words are told as they came");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Octets octets = fuzz::octets_of(data, size);
  check_permit(octets);
  check_vital(octets);
  return 0;
}
