// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "tests/integration/mortal_flight.hpp"

/// What has to be true of rokviss after its supervisor was lost in the midst of something, however it was lost.
namespace hirosco::testing {

inline constexpr std::array<const char*, 2> movers{"MANIPULATOR", "JOYSTICK"};

/// And again: the mode that holds is brought up whole.
inline void flies_again(MortalFlight& mortal) {
  Flight& flight = mortal.flight;
  for (const char* name : movers)
    if (!flight.craft().alive(name)) static_cast<void>(flight.set_state(name, State::Offline));
  flight.craft().run(200ms);
  EXPECT_TRUE(flight.set_mode("telepresence").completed) << mortal.text();
  flight.craft().run(200ms);
  for (const char* name : movers) EXPECT_TRUE(mortal.may_move(name)) << name << "\n" << mortal.text();
}

/// Of what was accepted; \return how many were told twice, the second time as unknown.
inline int each_telecommand_has_one_end(MortalFlight& mortal) {
  int told_twice = 0;
  for (const auto& [id, verdict] : mortal.verdicts.of) {
    EXPECT_LE(verdict.final - verdict.unknown, 1) << std::hex << id << "\n" << mortal.text();
    EXPECT_TRUE(verdict.accepted == 0 || verdict.final > 0) << std::hex << id << "\n" << mortal.text();
    told_twice += verdict.final > 1 ? 1 : 0;
  }
  return told_twice;
}

/// Of what was accepted, as ground hears it.
inline void ground_hears_one_end_each(MortalFlight& mortal) {
  for (const auto& [id, verdict] : mortal.heard.of) {
    EXPECT_LE(verdict.final, 1) << std::hex << id << "\n" << mortal.text();
    EXPECT_TRUE(verdict.accepted == 0 || verdict.final > 0) << std::hex << id << "\n" << mortal.text();
  }
}

/// Of a stop, as supervisors tell it: where it has a second end there was a mark ahead of that; \return how many had (docs/adr/0243).
inline int a_second_end_is_marked(MortalFlight& mortal) {
  int twice = 0;
  for (const auto& [id, verdict] : mortal.said.of) twice += verdict.final > 1 ? 1 : 0;
  EXPECT_TRUE(twice == 0 || mortal.flight.story().has("SUPERVISOR info END_TOLD_AGAIN")) << mortal.text();
  return twice;
}

/// Of a change from telepresence to standalone: in either of them, or in the one in which nobody moves. Counted in `ends`.
inline void is_in_the_old_mode_the_new_one_or_safe(MortalFlight& mortal, std::map<std::string, int>& ends) {
  Flight& flight = mortal.flight;
  const std::string now = flight.craft().supervisor().mode().name;
  EXPECT_TRUE(now == "telepresence" || now == "standalone" || now == flight.mission().initial_mode) << now;
  ++ends[now];
  if (now != flight.mission().initial_mode) return;
  for (const char* name : movers) EXPECT_FALSE(mortal.may_move(name)) << name << "\n" << mortal.text();
}

/// SAFE_ALL of which somebody has said that it was taken has stopped everybody; who was not stopped goes on, and nobody is in between.
inline void has_stopped_all_or_nobody(MortalFlight& mortal) {
  bool taken = false;
  for (const auto& [id, verdict] : mortal.verdicts.of) taken = taken || verdict.accepted > 0;
  for (const char* name : movers) {
    EXPECT_FALSE(taken && mortal.may_move(name)) << mortal.text();
    EXPECT_TRUE(mortal.may_move(name) || mortal.flight.state(name) != State::Operational) << mortal.text();
  }
}

/// A plan that was told to begin is carried out, whoever goes on with it: the network is down.
inline void what_was_told_to_begin_is_done(MortalFlight& mortal) {
  if (!mortal.flight.story().has("plan network-down")) return;
  for (const char* name : movers) EXPECT_EQ(mortal.flight.state(name), State::Offline) << name << "\n" << mortal.text();
}

inline void nobody_may_move(MortalFlight& mortal) {
  for (const char* name : movers) EXPECT_FALSE(mortal.may_move(name)) << name << "\n" << mortal.text();
}

/// Each number of the log once, in a record or in a gap that says how many are missing.
inline void the_log_is_continuous(MortalFlight& mortal) {
  std::uint64_t expected = 0;
  for (const auto& record : mortal.flight.records()) {
    if (expected != 0) {
      EXPECT_EQ(record.number, expected) << mortal.text();
    }
    expected = record.number + std::max<std::uint64_t>(record.lost, 1);
    if (::testing::Test::HasFailure()) return;
  }
  EXPECT_GT(expected, 1U) << "there is something in it";
}

}  // namespace hirosco::testing
