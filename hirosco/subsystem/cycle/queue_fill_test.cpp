// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/queue_fill.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "hirosco/subsystem/author/custom_service.hpp"
#include "hirosco/subsystem/testing/inside.hpp"

/// Queues between the loops of a subsystem are as large as its descriptor says; how full they were is told and warned of (docs/adr/0188).
namespace hirosco {
namespace {

using descriptor::Resource;
using testing::Rig;
using testing::Sent;
namespace framework = descriptor::framework_event;

TEST(QueueFill, IsAShareThatIsRoundedUpAndNeverMoreThanAll) {
  EXPECT_EQ((QueueFill{0, 64}.percent()), 0U);
  EXPECT_EQ((QueueFill{1, 65'536}.percent()), 1U) << "something was in it";
  EXPECT_EQ((QueueFill{48, 64}.percent()), 75U);
  EXPECT_EQ((QueueFill{4'194'304, 4'194'304}.percent()), 100U);
  EXPECT_EQ((QueueFill{7, 3}.percent()), 100U);
  EXPECT_EQ((QueueFill{7, 0}.percent()), 0U) << "there is none";
}

TEST(FillMark, KeepsTheMostUntilItIsTakenAndTakesARefusalForAFullQueue) {
  FillMark mark;
  mark.note(5, 0, 100);
  mark.note(30, 0, 100);
  mark.note(2, 0, 100);
  EXPECT_EQ(mark.take(), 30U);
  EXPECT_EQ(mark.take(), 0U);
  mark.note(50, 1, 100);
  EXPECT_EQ(mark.take(), 100U) << "what may have half only was refused at half";
  mark.note(50, 1, 100);
  EXPECT_EQ(mark.take(), 50U) << "and nothing since";
}

/// Events of the framework as they came: resource, used, limit.
std::vector<std::array<std::uint32_t, 3>> warnings(const Rig& rig) {
  std::vector<std::array<std::uint32_t, 3>> all;
  for (const auto& each : rig.raised) {
    if (each.id != framework::resource_warning) continue;
    OctetReader reader{each.auxiliary};
    const auto resource = reader.get<std::uint8_t>();
    static_cast<void>(reader.get<std::uint32_t>());
    const auto used = reader.get<std::uint32_t>();
    all.push_back({resource, used, reader.get<std::uint32_t>()});
  }
  return all;
}

std::uint8_t high(Rig& rig, Resource queue) {
  return rig.subsystem.cycle().resource_statistics().load().waiting.queues_high[place_of(queue)];
}

/// RESOURCE_STATS is made anew each 16 cycles, and looked for ten times in a second.
void tell(Rig& rig) {
  for (int i = 0; i < 120; ++i) {
    rig.service();
    rig.cycle();
  }
  rig.service();
}

struct Caller final : Subsystem {
  Event<std::uint32_t> remark{"REMARK"};
  int remarks{0};
  Result<Step> software_init() override {
    use_event(remark);
    on_function("GO", []() -> Result<> { return ok(); });
    return done;
  }
  Result<> pre_operational(const Cycle&) noexcept override {
    for (; remarks > 0; --remarks) raise(remark, 1U);
    return ok();
  }
};

std::string caller(const std::string& resources) {
  return R"(<Subsystem name="CALLER" id="21">)" + resources + R"(
    <EventService><Event name="REMARK" id="1" severity="low"><Argument name="N" type="UINT32"/></Event></EventService>
    <FunctionService><Function name="GO" states="PreOperational"/></FunctionService>
    <Configuration name="C" id="1" sampling_us="1000">
      <HKService id="1" interval="1"><SampledOnce><ParamRef name="CYCLE_TIMES"/></SampledOnce></HKService>
    </Configuration></Subsystem>)";
}

TEST(QueuesOfASubsystem, HousekeepingThatNobodyTakesIsWarnedOfByTheNameOfItsRing) {
  Caller author;
  Rig rig{author, caller(R"(<Resources cycle_housekeeping_kB="16"/>)")};
  rig.bring_to(State::PreOperational);
  tell(rig);
  EXPECT_TRUE(warnings(rig).empty());
  // 168 octets each: 8, 24, the id of the structure, 128, and what fills them up.
  rig.cycle(80);
  tell(rig);
  const auto told = warnings(rig);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0][0], static_cast<std::uint32_t>(Resource::CycleHousekeeping));
  EXPECT_EQ(told[0][2], 16'384U);
  EXPECT_GE(high(rig, Resource::CycleHousekeeping), 82U);
  EXPECT_LE(high(rig, Resource::CycleHousekeeping), 85U);
  EXPECT_EQ(rig.heard(framework::reports_lost), 0) << "told before anything was lost";
}

TEST(QueuesOfASubsystem, AreAsLargeAsTheDescriptorSays) {
  Caller author;
  Rig rig{author, caller(R"(<Resources cycle_housekeeping_kB="64"/>)")};
  rig.bring_to(State::PreOperational);
  rig.cycle(80);
  tell(rig);
  EXPECT_TRUE(warnings(rig).empty()) << "a quarter as full as one of 16 kB";
  EXPECT_LE(high(rig, Resource::CycleHousekeeping), 22U);
  EXPECT_GE(high(rig, Resource::CycleHousekeeping), 20U);
}

TEST(QueuesOfASubsystem, RefuseACommandBeyondWhatTheDescriptorSaysAndTellThatTheyWereFull) {
  Caller author;
  Rig rig{author, caller(R"(<Resources cycle_commands="16"/>)")};
  rig.bring_to(State::PreOperational);
  std::vector<Sent> calls;
  for (int i = 0; i < 20; ++i) calls.push_back(rig.call("GO"));
  rig.service();
  const auto refused = std::ranges::count_if(calls, [&](Sent call) { return rig.outcome(call) == "1 4:000b"; });
  EXPECT_EQ(refused, 4) << "the cycle has taken none yet";
  tell(rig);
  EXPECT_EQ(rig.outcome(calls[15]), "1 3 7");
  EXPECT_EQ(high(rig, Resource::CycleCommands), 100U);
  ASSERT_FALSE(warnings(rig).empty());
  EXPECT_EQ(warnings(rig)[0],
            (std::array<std::uint32_t, 3>{static_cast<std::uint32_t>(Resource::CycleCommands), 16, 16}));
}

TEST(QueuesOfASubsystem, RemarksThatMayHaveHalfOnlyAreWarnedOfWhereTheyAreLost) {
  Caller author;
  Rig rig{author, caller(R"(<Resources cycle_events_kB="16"/>)")};
  rig.bring_to(State::PreOperational);
  author.remarks = 1000;
  rig.cycle();
  tell(rig);
  EXPECT_EQ(high(rig, Resource::CycleEvents), 100U);
  const auto told = warnings(rig);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0], (std::array<std::uint32_t, 3>{static_cast<std::uint32_t>(Resource::CycleEvents), 16'384, 16'384}));
}

/// Whose service runs in a loop of its own, in which so many requests may wait.
struct Stored {
  struct Store final : Subsystem {
    CustomService store{"STORE"};
    Result<> offline() override {
      store.on_request("KEEP", []() -> Result<> { return ok(); });
      provide(store);
      return ok();
    }
  } author;
  Rig rig;
  explicit Stored(std::uint32_t queue)
      : rig{author, R"(<Subsystem name="STORE" id="21">
          <CustomService name="STORE" type="200"><Request name="KEEP" subtype="1"/></CustomService>
          <ServiceLoop name="SLOW" period_us="20000" queue=")" +
                        std::to_string(queue) + R"("/>
          <Service name="STORE" loop="SLOW"/>
          <Configuration name="C" id="1" sampling_us="1000"/></Subsystem>)"} {
    rig.bring_to(State::PreOperational);
  }
  /// Before the loop's next step.
  void ask(std::uint32_t requests) {
    for (std::uint32_t i = 0; i < requests; ++i) rig.send(200, 1, {});
    rig.service();
    rig.subsystem.own_loop_step(0, rig.clock.now());
    tell(rig);
  }
};

TEST(QueuesOfASubsystem, OfALoopOfServicesAreToldToo) {
  Stored stored{4};
  stored.ask(3);
  EXPECT_EQ(high(stored.rig, Resource::LoopRequests), 75U);
  EXPECT_GE(high(stored.rig, Resource::LoopReports), 1U);
  ASSERT_EQ(warnings(stored.rig).size(), 1U);
  EXPECT_EQ(warnings(stored.rig)[0],
            (std::array<std::uint32_t, 3>{static_cast<std::uint32_t>(Resource::LoopRequests), 3, 4}));
}

TEST(QueuesOfASubsystem, OneRequestThatFillsASmallQueueOfALoopIsNoWarningAndOneThatIsRefusedIs) {
  for (const std::uint32_t queue : {1U, 2U, 3U}) {
    Stored stored{queue};
    stored.ask(queue);
    EXPECT_EQ(high(stored.rig, Resource::LoopRequests), 100U);
    EXPECT_TRUE(warnings(stored.rig).empty()) << queue << ": it is made for that";
    stored.ask(queue + 1);
    ASSERT_EQ(warnings(stored.rig).size(), 1U) << queue;
    EXPECT_EQ(warnings(stored.rig)[0],
              (std::array<std::uint32_t, 3>{static_cast<std::uint32_t>(Resource::LoopRequests), queue, queue}));
  }
}

TEST(ControlChannelOfASubsystem, IsToldAsAShareAndWarnedOfWhereItsDescriptorSaysHowMuchItHolds) {
  for (const bool sized : {true, false}) {
    Caller author;
    Rig rig{author, caller(sized ? R"(<Resources channel_kB="64"/>)" : "")};
    rig.bring_to(State::PreOperational);
    tell(rig);
    ASSERT_TRUE(warnings(rig).empty());
    // The supervisor is there and does not read until 4096 messages fill the channel of this rig and the next ones wait behind it.
    constexpr int more_than_the_channel_holds = 4096 + 200;
    for (int i = 0; i < more_than_the_channel_holds; ++i) {
      rig.cycle();
      static_cast<void>(rig.subsystem.service_step(rig.clock.now()));
    }
    tell(rig);
    EXPECT_EQ(high(rig, Resource::Channel), 100U);
    EXPECT_EQ(rig.heard(framework::reports_lost), 0);
    const auto told = warnings(rig);
    ASSERT_EQ(told.size(), sized ? 1U : 0U) << "once, long before it was full";
    if (!sized) continue;
    EXPECT_EQ(told[0][0], static_cast<std::uint32_t>(Resource::Channel));
    EXPECT_GE(told[0][1], 48U);
    EXPECT_LE(told[0][1], 51U);
    EXPECT_EQ(told[0][2], 64U);
  }
}

}  // namespace
}  // namespace hirosco
