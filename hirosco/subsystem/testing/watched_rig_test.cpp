// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>
#include <string>

#include "hirosco/subsystem/testing/rig.hpp"
#include "hirosco/utilities/allocation_guard.hpp"

/// A rig fails the test of an author whose code does in a cycle what real time forbids (docs/adr/0230). What a hook tells of the C library's functions the
/// author here tells himself, so that no program has to have one; that an author's test has it shows tests/author.
namespace hirosco::testing {
namespace {

using ::testing::HasSubstr;
using Deed = std::function<void()>;

constexpr const char* clerk_descriptor = R"(<Subsystem name="CLERK" id="20">
  <FunctionService>
    <Function name="COUNT" states="PreOperational"/>
    <Function name="NOTE" states="PreOperational"/>
  </FunctionService>
  <TestService self_test_within_ms="20"/>
  <Configuration name="ONE" id="1" sampling_us="1000" self_test="optional"/>
  <Configuration name="TWO" id="2" sampling_us="2000"/>
  <Bumpless between="ONE TWO"/>
</Subsystem>
)";

/// An author whose code does what a test tells it, wherever a cycle calls it.
struct Clerk final : Subsystem {
  Deed in_service, in_handler, in_pre_operational, in_safe_operational, in_operational, in_error_operational,
      in_self_test, in_bumpless;

  static Result<> does(const Deed& deed) {
    if (deed) deed();
    return ok();
  }
  Result<Step> software_init() override {
    on_function("COUNT", [] { return ok(); });
    on_function("NOTE", [this] { return does(in_handler); });
    return done;
  }
  void service(TimePoint) override { static_cast<void>(does(in_service)); }
  Result<> pre_operational(const Cycle&) noexcept override { return does(in_pre_operational); }
  Result<> safe_operational(const Cycle&) noexcept override { return does(in_safe_operational); }
  Result<> operational(const Cycle&) noexcept override { return does(in_operational); }
  Result<> error_operational(const Cycle&) noexcept override { return does(in_error_operational); }
  Result<Step> self_test(const Cycle&) noexcept override {
    static_cast<void>(does(in_self_test));
    return done;
  }
  Result<> bumpless(const descriptor::Configuration&, const descriptor::Configuration&,
                    const Cycle&) noexcept override {
    return does(in_bumpless);
  }
};

struct WatchedRigTest : ::testing::Test {
  Clerk clerk;
  Rig rig{clerk, clerk_descriptor};
  static void takes() { hirosco_note_allocation(1); }
  static void gives_back() { hirosco_note_free(); }
  static void locks() { hirosco_note_lock(); }
  static void prints() { hirosco_note_output(); }

  /// What ends the test of an author, without its advice.
  static std::string ended_by(const Deed& test) {
    try {
      test();
    } catch (const std::runtime_error& error) {
      const std::string words = error.what();
      return words.substr(0, words.find(';'));
    }
    return "nothing";
  }
  std::string entering(State state) {
    return ended_by([&] { rig.set_state_now(state); });
  }
  std::string sending(std::uint8_t service, std::uint8_t subtype) {
    return ended_by([&] {
      rig.send(service, subtype, {});
      rig.settle();
    });
  }
  static std::string one_use_in(const std::string& where) {
    return "Rig::cycle: " + where +
           " of CLERK does in the cycle what real time forbids: 1 use of the heap, 0 locks, 0 outputs";
  }
};

TEST_F(WatchedRigTest, LetsPassWhoDoesNothingOfItInACycle) {
  clerk.in_service = [] { takes(), locks(), prints(); };
  rig.bring_to(State::Operational);
  EXPECT_EQ(ended_by([&] { rig.cycle(100); }), "nothing");
  EXPECT_EQ(rig.configure_now(2), "1 3 7");
  EXPECT_EQ(rig.set_state_now(State::ErrorOperational), "1 3 7");
}

TEST_F(WatchedRigTest, TellsHeapLockAndOutputApartAndHowOften) {
  rig.bring_to(State::Operational);
  clerk.in_operational = [] { takes(), takes(), gives_back(), locks(), locks(), prints(); };
  EXPECT_EQ(ended_by([&] { rig.cycle(); }),
            "Rig::cycle: operational() of CLERK does in the cycle what real time forbids: 3 uses of the heap, 2 locks, "
            "1 output");
  clerk.in_operational = locks;
  EXPECT_THAT(ended_by([&] { rig.cycle(); }), HasSubstr(": 0 uses of the heap, 1 lock, 0 outputs"));
  clerk.in_operational = prints;
  EXPECT_THAT(ended_by([&] { rig.cycle(); }), HasSubstr(": 0 uses of the heap, 0 locks, 1 output"));
}

TEST_F(WatchedRigTest, NamesTheNodeOfEachState) {
  rig.bring_to(State::PreOperational);
  clerk.in_pre_operational = takes;
  EXPECT_EQ(ended_by([&] { rig.cycle(); }), one_use_in("pre_operational()"));
  clerk.in_pre_operational = {};
  clerk.in_safe_operational = takes;
  EXPECT_EQ(entering(State::SafeOperational), one_use_in("safe_operational()"));
  clerk.in_safe_operational = {};
  rig.settle();
  clerk.in_operational = takes;
  EXPECT_EQ(entering(State::Operational), one_use_in("operational()"));
  clerk.in_operational = {};
  rig.settle();
  clerk.in_error_operational = takes;
  EXPECT_EQ(entering(State::ErrorOperational), one_use_in("error_operational()"));
}

TEST_F(WatchedRigTest, NamesTheFunctionWhoseHandlerItWas) {
  rig.bring_to(State::PreOperational);
  clerk.in_handler = takes;
  EXPECT_EQ(ended_by([&] { rig.call("COUNT"), rig.settle(); }), "nothing");
  EXPECT_EQ(ended_by([&] { rig.call("NOTE"), rig.settle(); }), one_use_in("the handler of NOTE"));
}

TEST_F(WatchedRigTest, NamesSelfTestAndBumplessChange) {
  rig.bring_to(State::SafeOperational);
  clerk.in_self_test = takes;
  EXPECT_EQ(sending(17, 128), one_use_in("self_test()"));
  rig.settle();
  clerk.in_bumpless = takes;
  EXPECT_EQ(ended_by([&] { rig.configure_now(2); }), one_use_in("bumpless()"));
}

TEST_F(WatchedRigTest, TellsEachCycleThatDoesItAndOfSeveralPiecesInOneTheFirst) {
  rig.bring_to(State::PreOperational);
  clerk.in_handler = clerk.in_pre_operational = takes;
  rig.call("NOTE");
  rig.service();
  EXPECT_EQ(ended_by([&] { rig.cycle(); }), one_use_in("the handler of NOTE"));
  EXPECT_EQ(ended_by([&] { rig.cycle(); }), one_use_in("pre_operational()"));
  EXPECT_EQ(ended_by([&] { rig.cycle(); }), one_use_in("pre_operational()"));
  clerk.in_pre_operational = {};
  EXPECT_EQ(ended_by([&] { rig.cycle(); }), "nothing") << "what was told is not told again";
}

TEST_F(WatchedRigTest, LetsATestThatSaysSoDoItInCyclesAndThenTellsNothingOfThese) {
  rig.bring_to(State::PreOperational);
  clerk.in_pre_operational = takes;
  rig.cycles_watched = false;
  EXPECT_EQ(ended_by([&] { rig.cycle(); }), "nothing");
  clerk.in_pre_operational = {};
  rig.cycles_watched = true;
  EXPECT_EQ(ended_by([&] { rig.cycle(); }), "nothing");
}

}  // namespace
}  // namespace hirosco::testing
