// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/guard/guard.hpp"
#include "supervisor/guard/testing/guard_rig.hpp"

/// Each word of both pages in each state: an optimised program of its own, for many flights of the guard.
namespace hirosco::supervisor {
namespace {

using testing::arm;
using testing::damages;
using ::testing::ElementsAre;
using testing::GuardTest;
using testing::Life;
using Kind = GuardFinding::Kind;
using namespace std::chrono_literals;

/// All states, permitted or not; calls `check` after each damage of each word of `page`.
template <class Check>
void damage_in_every_state(GuardTest& test, std::size_t octets, auto&& page_of, Check&& check) {
  for (std::uint32_t state = 0; state <= static_cast<std::uint32_t>(State::SoftwareDeinit); ++state)
    for (const bool released : {false, true})
      for (std::size_t word = 0; word < octets / sizeof(std::uint32_t); ++word)
        for (std::size_t choice = 0;; ++choice) {
          test.start(arm);
          test.cycling(arm, static_cast<State>(state));
          test.lives[arm].vital->configuration = 2;
          test.run(10ms);
          if (released) {
            EXPECT_TRUE(test.guard.release(arm, test.guard.fences(arm)));
          }
          test.run(5ms);
          static_cast<void>(test.guard.take_findings());
          std::uint32_t& hit = reinterpret_cast<std::uint32_t*>(page_of(test.lives[arm]))[word];
          const auto choices = damages(hit);
          if (choice >= choices.size()) break;
          hit = choices[choice];
          test.run(20ms);
          check(static_cast<State>(state), released, word * sizeof(std::uint32_t), choices[choice]);
          if (::testing::Test::HasFailure()) return;
        }
}

TEST_F(GuardTest, DamageOfAnyWordOfAVitalPageInAnyStatePermitsNothingAndWhatDecidesIsTold) {
  const auto vital = [](Life& life) { return life.vital; };
  damage_in_every_state(
      *this, offsetof(VitalPage, counters), vital,
      [&](State state, bool released, std::size_t at, std::uint32_t value) {
        EXPECT_FALSE(!released && (may_move(arm) || told.enabled != 0)) << at << ' ' << value;
        const bool decides = at < offsetof(VitalPage, inhibited) ||
                             (at >= offsetof(VitalPage, realtime) && at < offsetof(VitalPage, period_ns));
        if (!decides) return;
        EXPECT_THAT(kinds(arm), ElementsAre(Kind::PageDamaged)) << to_text(state) << ' ' << at << ' ' << value;
        EXPECT_FALSE(may_move(arm) || told.enabled != 0) << at << ' ' << value;
      });
}

TEST_F(GuardTest, DamageOfAnyWordOfAPermitPageInAnyStatePermitsNothingAndWhatGatesIsTold) {
  const auto permit = [](Life& life) { return life.permit; };
  damage_in_every_state(
      *this, sizeof(PermitPage), permit, [&](State state, bool released, std::size_t at, std::uint32_t value) {
        EXPECT_FALSE(!released && (may_move(arm) || told.enabled != 0)) << at << ' ' << value;
        const bool gates = at < offsetof(PermitPage, stop) ||
                           (at >= offsetof(PermitPage, go) && at < offsetof(PermitPage, mode_epoch));
        if (!gates) return;
        EXPECT_THAT(kinds(arm), ElementsAre(Kind::PageDamaged)) << to_text(state) << ' ' << at << ' ' << value;
        EXPECT_FALSE(may_move(arm) || told.enabled != 0) << at << ' ' << value;
      });
}

}  // namespace
}  // namespace hirosco::supervisor
