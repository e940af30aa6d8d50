// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "supervisor/supervision/testing/adoption_rig.hpp"
#include "tests/fuzz/fuzz.hpp"

/// What a supervisor finds in the journal of one that died, whatever is there. The memory of the journal holds no copy that is not within it; a whole copy
/// with anything as its content harms nobody: it is understood as a whole, or what moves is stopped, and what this supervisor notes is understood by
/// the next.
///
/// An input is memory as it is; then changes of what a flight has noted, four octets each: place (u16), what (replace, insert, erase, cut off), value.
namespace {

using namespace hirosco;
using namespace hirosco::supervisor;
using fuzz::expect;

struct Flight final : supervisor::testing::AdoptionTest {
  static constexpr std::array moved{supervisor::testing::arm, supervisor::testing::hand};

  Flight() {
    SetUp();
    begin();
  }
  /// ASSERT_TRUE returns, which a constructor may not.
  void begin() {
    start_all(descriptor::State::Operational);
    parts.own.start(craft.mode_epoch);
    parts.graph.set_up(1, true);
    for (const std::uint16_t apid : moved) {
      ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
      played[apid].vital->seen_epoch = played[apid].permit->epoch.load();
    }
    // A telecommand of the ground that nobody has answered yet.
    const auto move =
        supervisor::testing::telecommand(supervisor::testing::arm, 8, 1, supervisor::testing::call_data("MOVE_TO"));
    parts.telecommands.take({.packet = move, .origin = Origin::ground()});
    parts.telecommands.forward_durable();
  }
  void TestBody() override {}

  [[nodiscard]] bool moves(std::uint16_t apid) {
    const PermitPage& page = *played[apid].permit;
    return page.permits(page.epoch.load());
  }
  /// Another supervisor goes on from this content; true: it understood it.
  bool goes_on_from(Octets content) {
    expect(journal.write(content), "a journal has room");
    return next_understands();
  }
  bool next_understands() {
    story.clear();
    SupervisorParts& next = go_on();
    const bool understood = !was_told("nothing tells what that knew");
    if (!understood)
      for (const std::uint16_t apid : moved)
        expect(next.craft.guard.fenced(apid) && !moves(apid), "where nothing is known what moves is stopped");
    begins_to_hear(next);
    expect(next.memory.note(), "what is known has room");
    return understood;
  }
};

/// What a flight has noted.
[[nodiscard]] std::vector<std::byte> noted() {
  Flight flight;
  expect(flight.notes.note(), "what is known has room");
  const Octets newest = flight.journal.newest();
  return {newest.begin(), newest.end()};
}

[[nodiscard]] std::vector<std::byte> changed(std::vector<std::byte> content, Octets changes) {
  OctetReader reader{changes};
  constexpr std::size_t octets_of_a_change = 4;
  while (reader.remaining() >= octets_of_a_change && !content.empty()) {
    const auto place = static_cast<std::ptrdiff_t>(reader.get<std::uint16_t>() % content.size());
    const auto what = reader.get<std::uint8_t>() % 4;
    const auto value = static_cast<std::byte>(reader.get<std::uint8_t>());
    if (what == 0) content[static_cast<std::size_t>(place)] = value;
    else if (what == 1) content.insert(content.begin() + place, value);
    else if (what == 2) content.erase(content.begin() + place);
    else content.resize(static_cast<std::size_t>(place));
  }
  return content;
}

void check_memory(Octets octets) {
  std::vector<std::byte> memory{octets.begin(), octets.end()};
  const auto within = [&](Octets copy) {
    return copy.empty() || (copy.data() >= memory.data() && copy.data() + copy.size() <= memory.data() + memory.size());
  };
  Journal journal{memory};
  expect(within(journal.newest()), "a copy is within its memory");
  const Octets begin = octets.first(octets.size() / 4);
  if (!journal.write(begin)) return;
  expect(within(journal.newest()) && std::ranges::equal(journal.newest(), begin) &&
             std::ranges::equal(Journal{memory}.newest(), begin),
         "what is written over anything is found");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Nobody runs tests here: what the rig's own checks find ends the process, too.
  GTEST_FLAG_SET(throw_on_failure, true);
  static const auto content = noted();
  const Octets octets = fuzz::octets_of(data, size);
  check_memory(octets);
  Flight flight;
  const bool understood = flight.goes_on_from(changed(content, octets));
  if (size < 4)
    expect(understood && std::ranges::all_of(Flight::moved, [&](std::uint16_t apid) { return flight.moves(apid); }),
           "what nobody has changed is understood, and what moves moves on");
  if (understood) fuzz::taken();
  expect(flight.next_understands(), "what a supervisor notes the next one understands");
  return 0;
}
