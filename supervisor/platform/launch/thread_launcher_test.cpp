// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/thread_launcher.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>

#include "hirosco/data_transfer/device/local_flows.hpp"
#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/pus/st05_event/event_message.hpp"
#include "hirosco/subsystem/pages/pages.hpp"
#include "hirosco/subsystem/testing/probe.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/wait_set.hpp"

namespace hirosco::supervisor {
namespace {

/// What the author of the member does, told from outside.
struct Wish {
  std::atomic<int> made{0}, gone{0};
  std::atomic<bool> throws{false};
  std::atomic<bool> holds{false};  ///< its service loop does not come back while this is true
  std::atomic<std::uint64_t> held_turns{0};
  std::atomic<bool> works{false};  ///< each of its steps takes some of the processor
};

class Told final : public Subsystem {
 public:
  explicit Told(Wish& wish) : wish_{wish} { ++wish_.made; }
  ~Told() override { ++wish_.gone; }

 private:
  void service(TimePoint) override {
    if (wish_.throws) throw std::runtime_error{"its own reasons"};
    while (wish_.holds) ++wish_.held_turns;
    for (const TimePoint until = clock_.now() + 5ms; wish_.works && clock_.now() < until;) {}
  }
  SystemClock clock_;
  Wish& wish_;
};

struct ThreadLauncherTest : ::testing::Test {
  void SetUp() override {
    const descriptor::FileSource source = [](const std::filesystem::path&) -> Result<std::string> {
      return testing::probe_descriptor;
    };
    const auto read = descriptor::read_subsystem("probe.xml", source);
    ASSERT_TRUE(read.value);
    described.subsystem = *read.value;
    described.executable = "probe";
    other = described;
    other.subsystem.name = "OTHER";
    other.subsystem.id = 11;
    other.executable = "other";
    launcher.emplace(
        ThreadLauncher::Parts{.clock = clock,
                              .flows = flows,
                              .makers = {{"probe", [this] { return std::make_unique<Told>(wish); }},
                                         {"other", [this] { return std::make_unique<Told>(wish_of_other); }}},
                              .realtime = false,
                              .links = local_link_mechanisms(),
                              .explain = [this](std::string_view line) { said += line; }});
  }
  void TearDown() override { wish.holds = wish_of_other.holds = false; }

  static const VitalPage& vital(const LaunchedSubsystem& launched) {
    return *reinterpret_cast<const VitalPage*>(launched.vital.octets.data());
  }
  /// Waits for what another thread does; its own time limit is the test's.
  template <class Condition>
  static void wait_for(Condition&& condition) {
    while (!condition()) std::this_thread::yield();
  }
  std::optional<ProcessEnd> end_of(std::uint32_t process) {
    std::optional<ProcessEnd> end;
    wait_for([&] { return (end = launcher->ended(process)).has_value(); });
    return end;
  }

  /// Waits for the next one of it.
  static pus::EventMessage event_of(LaunchedSubsystem& launched, MessageBuffer& buffer) {
    for (;;) {
      const auto found = launched.port->channel().receive(buffer).value();
      if (found.flow != Flow::None && found.message.kind == MessageKind::Event)
        return pus::read_event_message(found.message.packet).value();
      std::this_thread::yield();
    }
  }

  SystemClock clock;
  LocalFlows flows;
  Wish wish, wish_of_other;
  descriptor::MissionSubsystem described, other;
  std::optional<ThreadLauncher> launcher;
  std::string said;
};

TEST_F(ThreadLauncherTest, AMemberLivesInItsThreadsAndEndsWhenItsChannelIsClosed) {
  auto launched = launcher->launch(described).value();
  wait_for([&] { return vital(launched).service_steps > 3; });
  EXPECT_EQ(wish.made, 1);
  EXPECT_FALSE(launcher->ended(launched.process));
  EXPECT_TRUE(launcher->any_running());
  launched.port.reset();
  const auto end = end_of(launched.process);
  EXPECT_FALSE(end->by_signal);
  EXPECT_EQ(end->value, 0);
  EXPECT_EQ(wish.gone, 1) << "with all that it holds";
  EXPECT_FALSE(launcher->any_running());
}

TEST_F(ThreadLauncherTest, ItsEndWakesWhoWaitsForIt) {
  auto launched = launcher->launch(described).value();
  WaitSet set;
  ASSERT_TRUE(set.add(launcher->wait_descriptor(launched.process)));
  EXPECT_TRUE(set.wait(Duration{0}).value().empty());
  launched.port.reset();
  EXPECT_EQ(set.wait(std::nullopt).value().size(), 1U);
  EXPECT_EQ(launcher->wait_descriptor(launched.process + 1), -1);
}

TEST_F(ThreadLauncherTest, OneThatComesBackLetsGoWhenItIsToBeEnded) {
  auto launched = launcher->launch(described).value();
  wait_for([&] { return vital(launched).service_steps > 3; });
  launcher->kill(launched.process);
  const auto end = end_of(launched.process);
  EXPECT_TRUE(end->by_signal);
  EXPECT_EQ(end->value, 9);
  MessageBuffer buffer;
  EXPECT_EQ(launched.port->channel().receive(buffer).error().code, ErrorCode::Unavailable);
  EXPECT_EQ(launched.port->channel().send({}).error().code, ErrorCode::Unavailable);
  EXPECT_FALSE(launcher->must_end(clock.now() + 1h)) << "the flight goes on";
}

TEST_F(ThreadLauncherTest, OneThatDoesNotComeBackIsNotStartedAgainAndIsTheEndOfTheFlight) {
  wish.holds = true;
  auto launched = launcher->launch(described).value();
  wait_for([&] { return wish.held_turns > 0; });
  const TimePoint told = clock.now();
  launched.grip->kill();
  EXPECT_FALSE(launcher->ended(launched.process)) << "nothing can end it";
  EXPECT_FALSE(launcher->must_end(told)) << "it has its patience";
  const auto why = launcher->must_end(clock.now() + ThreadLauncher::patience);
  ASSERT_TRUE(why);
  EXPECT_EQ(*why, "PROBE does not let go, and a thread cannot be ended: the whole flight ends");
  const auto again = launcher->launch(described);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, ErrorCode::Unavailable);
  wish.holds = false;
  EXPECT_TRUE(end_of(launched.process)->by_signal);
  EXPECT_FALSE(launcher->must_end(clock.now() + 1h));
  EXPECT_TRUE(launcher->launch(described)) << "now it may be started again";
}

TEST_F(ThreadLauncherTest, ItsControlChannelTakesAsManyMessagesAsItsDescriptorSays) {
  wish.holds = true;
  described.subsystem.resources.channel_kb = 64;
  auto launched = launcher->launch(described).value();
  wait_for([&] { return wish.held_turns > 0; });  // from here on it takes none
  int taken = 0;
  while (launched.port->channel().send({})) ++taken;
  EXPECT_EQ(taken, 64);
  wish.holds = false;
  launched.port.reset();
  static_cast<void>(end_of(launched.process));
}

TEST_F(ThreadLauncherTest, AnExceptionOfItsServiceLoopEndsItAloneAndIsTold) {
  auto bad = launcher->launch(described).value();
  auto good = launcher->launch(other).value();
  wait_for([&] { return vital(good).service_steps > 3; });
  wish.throws = true;
  const auto end = end_of(bad.process);
  EXPECT_FALSE(end->by_signal);
  EXPECT_EQ(end->value, 4);
  EXPECT_EQ(said, "PROBE: its own reasons");
  const auto before = vital(good).service_steps.load();
  wait_for([&] { return vital(good).service_steps > before; });
}

TEST_F(ThreadLauncherTest, ItsCountsGoOnWhereThoseBeforeEnded) {
  auto first = launcher->launch(described).value();
  auto& counters = reinterpret_cast<VitalPage*>(first.vital.octets.data())->counters;
  launcher->kill(first.process);
  static_cast<void>(end_of(first.process));
  std::memset(&counters, 0x5A, sizeof counters);
  auto second = launcher->launch(described).value();
  EXPECT_EQ(std::memcmp(&vital(second).counters, &counters, 16), 0);
}

TEST_F(ThreadLauncherTest, TheGripTellsWhoHadTheProcessorAndWhoRests) {
  wish.holds = true;
  auto busy = launcher->launch(described).value();
  auto idle = launcher->launch(other).value();
  // Of the member's other threads a part is the rest.
  wait_for([&] { return busy.grip->loop_time().service > 5ms; });
  EXPECT_TRUE(busy.grip->loop_time().runnable);
  EXPECT_GE(busy.grip->processor_time(), 5ms);
  EXPECT_EQ(busy.grip->loop_time().realtime, Duration{0}) << "it has no real-time priority";
  wait_for([&] { return !idle.grip->loop_time().runnable; });
}

TEST_F(ThreadLauncherTest, OfWhatAMemberTakesTheProcessorTimeOfItsLoopsIsKnownAndNothingElse) {
  wish.holds = true;
  auto busy = launcher->launch(described).value();
  auto idle = launcher->launch(other).value();
  wait_for([&] { return launcher->usage(busy.process)->processor > 50ms; });
  const ProcessUsage usage = launcher->usage(busy.process).value();
  EXPECT_EQ(usage.memory_kb + usage.shared_memory_kb + usage.threads + usage.descriptors, 0U) << "it is of all of them";
  EXPECT_LT(launcher->usage(idle.process)->processor, usage.processor);
  EXPECT_FALSE(launcher->usage(idle.process + 1)) << "nobody has this number";
  wish.holds = false;
  busy.port.reset();
  wait_for([&] { return !launcher->usage(busy.process); });
}

TEST_F(ThreadLauncherTest, AMemberWarnsOfTheProcessorTimeThatItsDescriptorSays) {
  described.subsystem.resources.most[static_cast<std::size_t>(descriptor::Resource::Processor)] = 2;
  wish.works = true;
  auto launched = launcher->launch(described).value();
  MessageBuffer buffer;
  pus::EventMessage event;
  do event = event_of(launched, buffer);
  while (event.id != descriptor::framework_event::resource_warning);
  EXPECT_EQ(std::to_integer<int>(event.auxiliary[0]), static_cast<int>(descriptor::Resource::Processor));
}

TEST_F(ThreadLauncherTest, WhatNobodyMakesIsRefusedByName) {
  descriptor::Mission mission;
  mission.subsystems.push_back(described);
  EXPECT_EQ(launcher->begin(mission).value(), "1 subsystems are threads of one process");
  mission.subsystems.push_back(described);
  mission.subsystems.back().executable = "absent";
  EXPECT_EQ(launcher->begin(mission).error(), "nobody here makes PROBE (absent)");
  EXPECT_EQ(launcher->launch(mission.subsystems.back()).error().code, ErrorCode::NotFound);
}

TEST_F(ThreadLauncherTest, AManifestThatItCannotHoldToIsRefused) {
  descriptor::Mission mission;
  mission.subsystems.push_back(described);
  mission.manifest.emplace();
  mission.manifest->file = "manifest.sha256";
  EXPECT_EQ(launcher->begin(mission).error(),
            "its manifest manifest.sha256 lists programs, and threads are none: it flies as processes only");
}

TEST_F(ThreadLauncherTest, ToldToEndAllItEndsAll) {
  auto first = launcher->launch(described).value();
  auto second = launcher->launch(other).value();
  launcher->kill_all();
  wait_for([&] { return !launcher->any_running(); });
  EXPECT_EQ(wish.gone + wish_of_other.gone, wish.made + wish_of_other.made);
}

TEST_F(ThreadLauncherTest, SaysWhatIsNotIsolated) {
  const auto says = [&](std::string_view word) {
    return std::ranges::any_of(launcher->isolation_lacks(),
                               [&](const std::string& line) { return line.contains(word); });
  };
  for (const auto word : {"share their memory", "sealed", "crash", "cannot be ended", "sandbox", "supervisor"})
    EXPECT_TRUE(says(word)) << word;
  for (const auto limit : {"memory_kB", "shared_memory_kB", "threads and", "descriptors", "processor_percent"})
    EXPECT_TRUE(says(limit)) << limit;
}

TEST_F(ThreadLauncherTest, SaysThatUsersOfAMissionAreNobodys) {
  descriptor::Mission mission;
  static_cast<void>(launcher->begin(mission).value());
  const auto without = launcher->isolation_lacks();
  mission.users = {.first = 60'600, .last = 60'699};
  static_cast<void>(launcher->begin(mission).value());
  const auto with = launcher->isolation_lacks();
  ASSERT_EQ(with.size(), without.size() + 1);
  EXPECT_EQ(with.back(),
            "users 60600-60699 that the mission names are nobody's: threads of one process are all of one user");
}

}  // namespace
}  // namespace hirosco::supervisor
