// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/subsystem/service_loop/generic_subsystem.hpp"
#include "hirosco/subsystem/testing/probe.hpp"
#include "hirosco/subsystem/testing/rig.hpp"

/// The author's self test from ST[17] to its report, and what Operational waits for (adr 0073).
namespace hirosco {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::Probe;
using testing::Rig;
using testing::Sent;
using ::testing::SizeIs;

constexpr std::uint8_t test_service = 17, run_test = 128, test_report = 129, report_test = 130;

/// With a self test that does what the test tells it.
class Tested : public Probe {
 public:
  std::function<Result<Step>()> says = [] { return Result<Step>{done}; };
  int calls{0}, firsts{0};
  std::vector<State> states;
  std::function<void()> in_function;  ///< while the cycle takes its commands

 protected:
  Result<Step> software_init() override {
    const auto step = Probe::software_init();
    on_function("SET_GOAL", [this](double) -> Result<> {
      if (in_function) in_function();
      return ok();
    });
    return step;
  }
  Result<Step> self_test(const Cycle& cycle) noexcept override {
    ++calls;
    if (cycle.first) ++firsts;
    states.push_back(cycle.state);
    arm.output().torque = 9.0;  // whatever it wants
    return says();
  }
};

std::string with(const char* attribute) {
  std::string text = testing::probe_descriptor;
  const std::string before = R"(<Configuration name="WITH_ARM" id="3")";
  text.replace(text.find(before), before.size(), before + " " + attribute);
  return text.insert(text.find("<Device name=\"ARM\""), R"(<TestService self_test_within_ms="20"/>)");
}

/// The test plays arm and lamp of configuration 3, whose cycle takes 2 ms.
struct SelfTestRig : ::testing::Test {
  explicit SelfTestRig(const char* attribute = "") : rig{author, with(attribute)} {}

  Tested author;
  Rig rig;
  std::unique_ptr<DataFlow> arm = open("arm");
  std::unique_ptr<DataFlow> lamp = open("lamp");
  bool arm_answers{true};
  std::vector<double> torques;  ///< that the arm was told
  std::vector<DeviceMode> modes;

  std::unique_ptr<DataFlow> open(const char* address) {
    return std::move(rig.flows.open({Transfer::SharedMemory, address}, FlowSide::Device)).value();
  }
  void answer(DataFlow& flow, std::size_t payload_octets) {
    std::array<std::byte, max_device_frame_octets> frame{}, buffer{};
    const auto found = flow.receive(frame);
    if (!found || found->flow != Flow::New) return;
    const auto command = read_command(Octets{frame}.first(found->octets)).value();
    if (&flow == arm.get()) {
      OctetReader reader{command.payload, std::endian::little};
      torques.push_back(reader.get<double>());
      modes.push_back(command.mode);
      if (!arm_answers) return;
    }
    const std::array<std::byte, 8> payload{};
    const auto status = write_status(
        buffer,
        {.epoch = command.epoch, .sequence = command.sequence, .payload = Octets{payload}.first(payload_octets)});
    static_cast<void>(flow.send(status.value()));
  }
  void exchange(int cycles = 1) {
    for (int i = 0; i < cycles; ++i) {
      rig.service();
      rig.cycle();
      answer(*arm, 8);
      answer(*lamp, 1);
    }
    rig.service();
  }
  std::string after(Sent request, int cycles = 4) {
    exchange(cycles);
    return rig.outcome(request);
  }
  std::string go(State state) { return after(rig.set_state(state), 6); }
  void up_to(State state) {
    ASSERT_EQ(go(State::PreOperational), "1 3 7");
    ASSERT_EQ(after(rig.configure(3)), "1 3 7");
    if (state == State::PreOperational) return;
    ASSERT_EQ(go(State::SafeOperational), "1 3 7");
    if (state == State::SafeOperational) return;
    ASSERT_EQ(go(state), "1 3 7");
  }
  Sent ask() { return rig.send(test_service, run_test, {}); }
  std::string run() { return after(ask()); }
  /// Outcome and configuration of the newest report of its outcome.
  std::string told() {
    const auto reports = rig.reports(test_service, test_report);
    return reports.empty() ? "nothing" : reports.back().substr(0, 4);
  }
  std::string known() {
    static_cast<void>(after(rig.send(test_service, report_test, {})));
    return told();
  }
  static std::string words(std::string_view text) { return testing::hex(std::as_bytes(std::span{text})); }
};

TEST_F(SelfTestRig, IsCalledCycleByCycleUntilItIsDoneAndReportsThat) {
  up_to(State::SafeOperational);
  author.says = [this]() -> Result<Step> { return author.calls < 9 ? again : done; };
  const Sent request = ask();
  EXPECT_EQ(after(request, 3), "1 3") << "it has begun";
  EXPECT_EQ(known(), "0303") << "and runs";
  EXPECT_EQ(after(request, 8), "1 3 7");
  EXPECT_EQ(author.calls, 9);
  EXPECT_EQ(author.firsts, 1);
  EXPECT_EQ(told(), "0103") << "passed, in configuration 3";
  exchange(5);
  EXPECT_EQ(author.calls, 9) << "it is over";
}

TEST_F(SelfTestRig, FailsWithTheReasonAndTheNumberOfItsAuthor) {
  up_to(State::SafeOperational);
  author.says = [] { return fail(ErrorCode::Internal, "sensor is broken", 42); };
  EXPECT_EQ(run(),
            "1 3 8:0202"
            "ff0b"
            "000000000000002a" +
                words("sensor is broken"));
  const auto reports = rig.reports(test_service, test_report);
  ASSERT_THAT(reports, SizeIs(1));
  EXPECT_EQ(reports[0].substr(0, 4), "0203");
  EXPECT_EQ(reports[0].substr(4 + 14),
            "0202"
            "000000000000002a"
            "10" +
                words("sensor is broken"));
  EXPECT_EQ(author.calls, 1);
}

TEST_F(SelfTestRig, ThatIsNotDoneInItsTimeHasFailedWithThatReason) {
  up_to(State::SafeOperational);
  author.says = [] { return Result<Step>{again}; };
  const Sent request = ask();
  EXPECT_EQ(after(request, 10), "1 3") << "18 of 20 ms";
  EXPECT_EQ(after(request, 2),
            "1 3 8:0203"
            "ff09"
            "0000000000000014" +
                words("self test: not done in its time, ms"));
  const int calls = author.calls;
  EXPECT_EQ(calls, 11) << "at 0, 2, ... 20 ms";
  exchange(5);
  EXPECT_EQ(author.calls, calls);
}

TEST_F(SelfTestRig, ThatItsAuthorDidNotWriteFails) {
  Probe without;
  Rig plain{without, testing::probe_descriptor};
  plain.bring_to(State::SafeOperational);
  const Sent request = plain.send(test_service, run_test, {});
  plain.settle();
  EXPECT_EQ(plain.outcome(request),
            "1 3 8:0202"
            "ff02"
            "0000000000000000" +
                words("it has no self test"));
}

TEST_F(SelfTestRig, IsRefusedInEveryStateButSafeOperational) {
  const auto refused = [](State state) { return "1 4:000a0" + std::to_string(static_cast<int>(state)); };
  EXPECT_EQ(run(), refused(State::Offline));
  for (const State transient : {State::SoftwareInit, State::HardwareInit}) {
    author.nodes[transient].again = 4;
    static_cast<void>(rig.set_state(State::PreOperational));
    exchange(2);
    EXPECT_EQ(rig.state(), transient);
    EXPECT_EQ(after(ask(), 1), refused(transient));
    exchange(8);
    if (rig.state() == State::PreOperational) break;
    exchange(8);
  }
  EXPECT_EQ(rig.state(), State::PreOperational);
  EXPECT_EQ(run(), refused(State::PreOperational));
  ASSERT_EQ(after(rig.configure(3)), "1 3 7");
  EXPECT_EQ(run(), refused(State::PreOperational));
  ASSERT_EQ(go(State::SafeOperational), "1 3 7");
  ASSERT_EQ(go(State::Operational), "1 3 7");
  EXPECT_EQ(run(), refused(State::Operational));
  ASSERT_EQ(go(State::ErrorOperational), "1 3 7");
  EXPECT_EQ(run(), refused(State::ErrorOperational));
  ASSERT_EQ(go(State::PostOperational), "1 3 7");
  EXPECT_EQ(run(), refused(State::PostOperational));
  for (const State transient : {State::HardwareDeinit, State::SoftwareDeinit}) author.nodes[transient].again = 4;
  static_cast<void>(rig.set_state(State::Offline));
  exchange(2);
  EXPECT_EQ(rig.state(), State::HardwareDeinit);
  EXPECT_EQ(after(ask(), 1), refused(State::HardwareDeinit));
  while (rig.state() == State::HardwareDeinit) exchange();
  EXPECT_EQ(after(ask(), 1), refused(State::SoftwareDeinit));
  EXPECT_EQ(author.calls, 0);
}

TEST_F(SelfTestRig, NeverPutsAnythingOutWhateverItWantsAndWhereverItIsSent) {
  constexpr double safe = -1.0;
  for (int number = 0; number < 10; ++number) {
    const auto next = static_cast<State>(number);
    SCOPED_TRACE(to_text(next));
    up_to(State::SafeOperational);
    author.says = [] { return Result<Step>{again}; };
    torques.clear();
    modes.clear();
    const Sent request = ask();
    exchange(4);
    static_cast<void>(go(next));
    exchange(20);
    EXPECT_NE(rig.state(), State::Operational);
    EXPECT_EQ(rig.outcome(request).substr(0, 5), "1 3 8");
    EXPECT_THAT(torques, SizeIs(::testing::Ge(4U)));
    EXPECT_THAT(torques, ::testing::Each(safe));
    EXPECT_THAT(modes, ::testing::Each(::testing::Ne(DeviceMode::Active)));
    if (rig.state() == State::ErrorOperational) static_cast<void>(go(State::PostOperational));
    if (rig.state() != State::Offline) static_cast<void>(go(State::Offline));
    ASSERT_EQ(rig.state(), State::Offline);
  }
  EXPECT_THAT(author.states, ::testing::Each(State::SafeOperational));
  EXPECT_GT(author.calls, 10);
}

TEST_F(SelfTestRig, IsGivenUpWhenTheSubsystemGoesElsewhere) {
  for (const State next : {State::PostOperational, State::ErrorOperational}) {
    up_to(State::SafeOperational);
    author.says = [] { return Result<Step>{again}; };
    const Sent request = ask();
    exchange(3);
    EXPECT_EQ(go(next), "1 3 7");
    EXPECT_EQ(rig.outcome(request).substr(0, 14),
              "1 3 8:0204ff0" + std::string{next == State::PostOperational ? "5" : "4"});
    EXPECT_EQ(told(), "0203") << "failed";
    if (next != State::PostOperational) static_cast<void>(go(State::PostOperational));
    ASSERT_EQ(go(State::Offline), "1 3 7");
  }
}

TEST_F(SelfTestRig, IsGivenUpWhenItsNodeFails) {
  up_to(State::SafeOperational);
  author.says = [] { return Result<Step>{again}; };
  const Sent request = ask();
  exchange(3);
  author.nodes[State::SafeOperational].fails = true;
  const std::string outcome = after(request, 6);
  EXPECT_EQ(outcome,
            "1 3 8:0204"
            "ff05"
            "0000000000000000" +
                words("self test: the node of Safe-Operational failed"));
  EXPECT_EQ(rig.state(), State::ErrorOperational);
}

TEST_F(SelfTestRig, OnlyOneRunsAndNothingIsPutOutBeforeItHasEnded) {
  up_to(State::SafeOperational);
  author.says = [] { return Result<Step>{again}; };
  const Sent first = ask();
  exchange(2);
  EXPECT_EQ(after(ask(), 1), "1 4:0108") << "busy";
  EXPECT_EQ(after(rig.set_state(State::Operational), 2), "1 4:0108") << "busy, in any configuration";
  author.says = [] { return Result<Step>{done}; };
  EXPECT_EQ(after(first), "1 3 7");
  EXPECT_EQ(go(State::Operational), "1 3 7");
}

TEST_F(SelfTestRig, NobodyWaitsForItWhereItIsNotRequired) {
  up_to(State::SafeOperational);
  author.says = [] { return fail(ErrorCode::Internal, "no"); };
  EXPECT_EQ(run().substr(0, 5), "1 3 8");
  EXPECT_EQ(go(State::Operational), "1 3 7");
}

// --- required ----------------------------------------------------------------------------------------------------------

struct RequiredSelfTest : SelfTestRig {
  RequiredSelfTest() : SelfTestRig{R"(self_test="required")"} {}
  static std::string refusal(std::string_view why, std::int64_t number = 0) {
    std::array<std::byte, 8> octets{};
    OctetWriter{octets}.put(number);
    return "1 4:010a"
           "ff04" +
           testing::hex(octets) + words(why);
  }
  static constexpr const char* not_run = "it has not run in this configuration: run SELF_TEST";
};

TEST_F(RequiredSelfTest, KeepsFromOperationalUntilItHasPassed) {
  up_to(State::SafeOperational);
  EXPECT_EQ(known(), "0003") << "never run";
  EXPECT_EQ(go(State::Operational), refusal(not_run));
  author.says = [] { return fail(ErrorCode::Internal, "torque has the wrong sign", 2); };
  EXPECT_EQ(run().substr(0, 5), "1 3 8");
  EXPECT_EQ(go(State::Operational), refusal("torque has the wrong sign", 2));
  EXPECT_EQ(rig.state(), State::SafeOperational);
  EXPECT_THAT(torques, ::testing::Each(-1.0));
  author.says = [] { return Result<Step>{done}; };
  EXPECT_EQ(run(), "1 3 7");
  EXPECT_EQ(go(State::Operational), "1 3 7");
  EXPECT_EQ(go(State::SafeOperational), "1 3 7");
  EXPECT_EQ(go(State::Operational), "1 3 7") << "a pass lasts";
}

TEST_F(RequiredSelfTest, ThatFailsAfterItHadPassedCountsAsFailed) {
  up_to(State::SafeOperational);
  EXPECT_EQ(run(), "1 3 7");
  author.says = [] { return fail(ErrorCode::Internal, "no"); };
  EXPECT_EQ(run().substr(0, 5), "1 3 8");
  EXPECT_EQ(go(State::Operational), refusal("no"));
}

TEST_F(RequiredSelfTest, IsVoidAfterADeviceWasLost) {
  up_to(State::SafeOperational);
  EXPECT_EQ(run(), "1 3 7");
  arm_answers = false;
  exchange(8);
  EXPECT_EQ(rig.events(testing::arm_lost), 1);
  EXPECT_EQ(known(), "0403");
  arm_answers = true;
  exchange(8);
  EXPECT_EQ(known(), "0403") << "its coming back heals nothing";
  EXPECT_EQ(go(State::Operational), refusal("it passed before a device was lost: run SELF_TEST again"));
  EXPECT_EQ(run(), "1 3 7");
  EXPECT_EQ(go(State::Operational), "1 3 7");
}

TEST_F(RequiredSelfTest, FailsWhenADeviceIsLostWhileItRuns) {
  up_to(State::SafeOperational);
  author.says = [] { return Result<Step>{again}; };
  const Sent request = ask();
  arm_answers = false;
  exchange(8);
  EXPECT_EQ(rig.outcome(request),
            "1 3 8:0204"
            "ff05"
            "0000000000000000" +
                words("self test: a device was lost, number"));
}

TEST_F(RequiredSelfTest, IsVoidAfterErrorOperationalAndInTheNextConfiguration) {
  up_to(State::SafeOperational);
  EXPECT_EQ(run(), "1 3 7");
  EXPECT_EQ(go(State::ErrorOperational), "1 3 7");
  EXPECT_EQ(known(), "0403");
  EXPECT_EQ(go(State::PostOperational), "1 3 7");
  EXPECT_EQ(known(), "0403");
  up_to(State::SafeOperational);
  EXPECT_EQ(known(), "0003") << "it is another configuration, if the same";
  EXPECT_EQ(go(State::Operational), refusal(not_run));
  EXPECT_EQ(run(), "1 3 7");
  EXPECT_EQ(go(State::PostOperational), "1 3 7");
  up_to(State::SafeOperational);
  EXPECT_EQ(go(State::Operational), refusal(not_run));
}

TEST_F(RequiredSelfTest, IsLookedAtAgainByTheCycleThatWouldPutOut) {
  up_to(State::SafeOperational);
  EXPECT_EQ(run(), "1 3 7");
  arm_answers = false;
  exchange(3);
  // The service loop permits the entry in just the cycle that then finds its device silent.
  Sent entry;
  author.in_function = [&] {
    entry = rig.set_state(State::Operational);
    rig.service();
  };
  static_cast<void>(rig.call("SET_GOAL", {1.0}));
  exchange(1);
  EXPECT_EQ(rig.events(testing::arm_lost), 1);
  EXPECT_EQ(rig.outcome(entry), "1 3") << "it is on its way";
  exchange(4);
  EXPECT_EQ(rig.outcome(entry),
            "1 3 8:0202"
            "ff04"
            "0000000000000000" +
                words("the required self test is not passed"));
  EXPECT_EQ(rig.state(), State::ErrorOperational);
  EXPECT_THAT(torques, ::testing::Each(-1.0));
}

TEST(RequiredWithoutActuator, IsAskedForAllTheSame) {
  Tested author;
  std::string text = testing::probe_descriptor;
  const std::string before = R"(<Configuration name="ALONE" id="1")";
  text.replace(text.find(before), before.size(), before + R"( self_test="required")");
  Rig rig{author, text};
  rig.bring_to(State::SafeOperational);
  EXPECT_EQ(rig.set_state_now(State::Operational).substr(0, 8), "1 4:010a");
  static_cast<void>(rig.send(test_service, run_test, {}));
  rig.settle();
  EXPECT_EQ(rig.set_state_now(State::Operational), "1 3 7");
}

}  // namespace
}  // namespace hirosco
