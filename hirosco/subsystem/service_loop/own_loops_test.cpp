// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/subsystem/author/custom_service.hpp"
#include "hirosco/subsystem/testing/inside.hpp"

/// Services in a loop of their own: requests wait for its step, reports go out by the service loop, and one that hangs is seen.
namespace hirosco {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::Rig;
using testing::Sent;

constexpr const char* archive_descriptor = R"(<Subsystem name="ARCHIVE" id="10">
  <ParamRef name="FILES" id="0" type="UINT32" init="7" minimum="0" maximum="1000"
            writable="PreOperational SafeOperational Operational"/>
  <EventService><Event name="FULL" id="5" severity="low"><Argument name="FILES" type="UINT32"/></Event></EventService>
  <CustomService name="STORE" type="200">
    <Request name="KEEP" subtype="1" states="PreOperational Operational"><Argument name="FILES" type="UINT32" minimum="0" maximum="9"/></Request>
    <Report name="KEPT" subtype="2"><Field name="FILES" type="UINT32"/></Report>
  </CustomService>
  <CustomService name="HERE" type="201"><Request name="LOOK" subtype="1"/></CustomService>
  <ServiceLoop name="SLOW" period_us="20000" priority="12" queue="3"/>
  <Service name="STORE" loop="SLOW"/>
  <Service name="ST03" loop="SLOW"/>
  <Configuration name="FIRST" id="1" sampling_us="1000">
    <HKService id="9" interval="5"><SampledOnce><ParamRef name="FILES"/></SampledOnce></HKService>
  </Configuration>
  <Configuration name="BARE" id="2" sampling_us="1000"><Service name="STORE" offered="no"/><Service name="ST03" offered="no"/>
    <Service name="ST20" offered="no"/></Configuration>
</Subsystem>)";

struct Archive final : Subsystem {
  CustomService store{"STORE"}, here{"HERE"};
  Parameter<std::uint32_t> files;
  Event<std::uint32_t> full{"FULL"};
  std::vector<std::uint32_t> kept;
  std::vector<TimePoint> steps;
  int steps_here{0};
  std::function<void()> during;

  Result<> offline() override {
    store.on_request("KEEP", [this](std::uint32_t number, Call call) -> Result<> {
      kept.push_back(number);
      if (during) during();
      if (auto set = store.store(files, number); !set) return set;
      if (auto said = store.raise(full, number); !said) return said;
      return store.report("KEPT", call, number);
    });
    store.on_step([this](TimePoint now) { steps.push_back(now); });
    here.on_request("LOOK", []() -> Result<> { return ok(); });
    here.on_step([this](TimePoint) { ++steps_here; });
    provide(store);
    provide(here);
    return ok();
  }
  Result<Step> software_init() override {
    publish("FILES", files);
    use_event(full);
    return done;
  }
};

struct OwnLoops : ::testing::Test {
  Archive author;
  Rig rig{author, archive_descriptor};

  Sent keep(std::uint32_t number, std::uint32_t mode_epoch = 0) {
    std::array<std::byte, 4> data;
    OctetWriter{data}.put(number);
    return rig.send(200, 1, data, {}, mode_epoch);
  }
  TimePoint step_loop() {
    const TimePoint next = rig.subsystem.own_loop_step(0, rig.clock.now());
    rig.service();
    return next;
  }
  std::uint64_t service_steps() const { return rig.vital.service_steps.load(); }
};

TEST_F(OwnLoops, HandleTheirRequestsInTheirOwnStepAndSayEverythingByTheServiceLoop) {
  rig.bring_to(State::PreOperational);
  rig.forget_telemetry();
  const Sent sent = keep(4);
  rig.settle();
  EXPECT_EQ(rig.outcome(sent), "") << "the service loop does not do it";
  EXPECT_THAT(author.kept, IsEmpty());
  rig.service();
  EXPECT_FALSE(rig.subsystem.has_reports());
  rig.subsystem.own_loop_step(0, rig.clock.now());
  EXPECT_THAT(author.kept, ElementsAre(4));
  EXPECT_TRUE(rig.subsystem.has_reports());
  EXPECT_EQ(rig.outcome(sent), "") << "only the service loop speaks with the supervisor";
  rig.service();
  EXPECT_EQ(rig.outcome(sent), "1 3 7");
  EXPECT_THAT(rig.reports(200, 2), ElementsAre("00000004"));
  EXPECT_EQ(rig.events(5), 1);
  EXPECT_EQ(std::ranges::find(rig.telemetry, 200, &testing::Telemetry::service)->destination, Rig::source);
}

TEST_F(OwnLoops, StepOnTheirGridAndOthersWithTheServiceLoop) {
  const TimePoint start = rig.clock.now();
  EXPECT_EQ(rig.subsystem.own_loops(), 1U);
  EXPECT_EQ(step_loop(), start + 20ms);
  EXPECT_THAT(author.steps, ElementsAre(start));
  const int here = author.steps_here;
  rig.service();
  EXPECT_EQ(author.steps_here, here + 1);
  EXPECT_EQ(author.steps.size(), 1U);
  rig.advance(70ms);
  EXPECT_EQ(rig.subsystem.own_loop_step(0, start + 20ms), start + 80ms) << "what was missed is skipped";
}

TEST_F(OwnLoops, SetAParameterWholeAtACycleBoundaryAndAtOnceWhereNoCycleRuns) {
  rig.bring_to(State::PreOperational);
  static_cast<void>(keep(4));
  rig.service();
  rig.subsystem.own_loop_step(0, rig.clock.now());
  std::uint32_t seen = 0;
  ASSERT_TRUE(author.files.snapshot(seen));
  EXPECT_EQ(seen, 7U);
  rig.cycle();
  ASSERT_TRUE(author.files.snapshot(seen));
  EXPECT_EQ(seen, 4U);
  rig.set_state_now(State::Offline);
  rig.bring_to(State::PreOperational, 0);
  static_cast<void>(keep(5));
  rig.service();
  rig.subsystem.own_loop_step(0, rig.clock.now());
  rig.service();
  ASSERT_TRUE(author.files.snapshot(seen));
  EXPECT_EQ(seen, 5U);
}

TEST_F(OwnLoops, LetNoMoreWaitThanDeclaredAndLoseNone) {
  rig.bring_to(State::PreOperational);
  std::vector<Sent> sent;
  for (std::uint32_t i = 0; i < 5; ++i) sent.push_back(keep(i));
  rig.service();
  EXPECT_EQ(rig.outcome(sent[3]), "2:000b");
  EXPECT_EQ(rig.outcome(sent[4]), "2:000b");
  step_loop();
  for (int i = 0; i < 3; ++i) EXPECT_EQ(rig.outcome(sent[static_cast<std::size_t>(i)]), "1 3 7");
  EXPECT_THAT(author.kept, ElementsAre(0, 1, 2));
  const Sent more = keep(6);
  rig.service();
  step_loop();
  EXPECT_EQ(rig.outcome(more), "1 3 7") << "there is room again";
}

TEST_F(OwnLoops, LookAtStateAndModeWhenTheyDoItNotWhenItCame) {
  rig.bring_to(State::PreOperational);
  rig.permit.mode_epoch = 3;
  const Sent old = keep(1, 3), of_state = keep(2);
  rig.service();
  rig.permit.mode_epoch = 4;
  rig.set_state_now(State::SafeOperational);
  step_loop();
  EXPECT_EQ(rig.outcome(old).substr(0, 6), "2:000d");
  EXPECT_EQ(rig.outcome(of_state), "2:000a04");
  EXPECT_THAT(author.kept, IsEmpty());
}

TEST_F(OwnLoops, LookAtTheModeOfTheSupervisorThatGoesOnForOneThatDied) {
  rig.bring_to(State::PreOperational);
  rig.permit.mode_epoch = 3;
  const Sent old = keep(1, 3);
  rig.service();
  const MemoryHandle memory = rig.memory.create("permit", sizeof(PermitPage)).value();
  const Mapping mapped = rig.memory.map(memory, Access::ReadWrite).value();
  ::new (mapped.octets.data()) PermitPage;
  reinterpret_cast<PermitPage*>(mapped.octets.data())->mode_epoch = 4;
  ASSERT_TRUE(rig.memory.seal_writers(memory));
  ASSERT_TRUE(rig.channels.supervisor_end().send({.kind = MessageKind::PermitPage, .memory = memory}));
  rig.service();
  step_loop();
  EXPECT_EQ(rig.outcome(old).substr(0, 6), "2:000d");
  EXPECT_THAT(author.kept, IsEmpty());
}

TEST_F(OwnLoops, AnswerBesideAServiceThatNeverStopsTalking) {
  rig.bring_to(State::PreOperational);
  int said = 0;
  author.store.on_step([&](TimePoint) {
    for (int i = 0; i < 10'000; ++i)
      if (author.store.report("KEPT", Call{}, std::uint32_t{1})) ++said;
  });
  const Sent sent = keep(1);
  rig.service();
  rig.subsystem.own_loop_step(0, rig.clock.now());
  EXPECT_GT(said, 100);
  EXPECT_LT(said, 10'000) << "what it says by itself is bounded and refused to whoever says it";
  const Sent later = keep(2);
  rig.service();
  for (int i = 0; i < 60; ++i) step_loop();
  EXPECT_EQ(rig.outcome(sent).substr(0, 3), "1 3");
  EXPECT_EQ(rig.outcome(later).substr(0, 1), "1") << "it waited, and nothing was lost";
  EXPECT_EQ(rig.events(descriptor::framework_event::reports_lost), 0);
}

TEST_F(OwnLoops, HostHousekeepingWhoseReportsGoOnFromTheCycle) {
  rig.bring_to(State::PreOperational);
  rig.settle();
  EXPECT_THAT(rig.reports(3, 25), ::testing::Not(IsEmpty()));
  const std::array data{std::byte{1}, std::byte{0}, std::byte{9}};
  const Sent off = rig.send(3, 6, data);
  rig.settle();
  EXPECT_EQ(rig.outcome(off), "");
  step_loop();
  EXPECT_EQ(rig.outcome(off), "1 3 7");
  rig.settle();
  rig.forget_telemetry();
  rig.settle();
  EXPECT_THAT(rig.reports(3, 25), IsEmpty());
}

TEST_F(OwnLoops, ThatHangInAStepKeepTheServiceLoopFromCountingOnAndAreTold) {
  rig.bring_to(State::PreOperational);
  std::vector<std::uint64_t> counted;
  author.during = [&] {
    // The other thread goes on meanwhile: a test has one, so it is stepped from inside.
    for (int i = 0; i < 20; ++i) {
      rig.advance(50ms);
      rig.service();
      counted.push_back(service_steps());
    }
  };
  static_cast<void>(keep(1));
  rig.service();
  rig.subsystem.own_loop_step(0, rig.clock.now());
  ASSERT_EQ(counted.size(), 20U);
  EXPECT_GT(counted[8], counted[7]) << "a slow request is none that hangs";
  EXPECT_EQ(counted[19], counted[11]) << "half a second later the guard sees the service loop stand still";
  EXPECT_EQ(rig.events(descriptor::framework_event::service_loop_hangs), 1);
  const std::uint64_t before = service_steps();
  rig.service();
  EXPECT_EQ(service_steps(), before + 1) << "and go on when it has ended";
}

TEST_F(OwnLoops, ThatWaitForTheProcessorOrForTheComputerAreNotSaidToHang) {
  rig.bring_to(State::PreOperational);
  for (int i = 0; i < 100; ++i) {
    rig.advance(50ms);
    const std::uint64_t before = service_steps();
    rig.service();
    EXPECT_EQ(service_steps(), before + 1) << "no step was begun";
  }
  author.during = [&] {
    rig.advance(30s);
    rig.service();
    rig.service();
  };
  static_cast<void>(keep(1));
  rig.service();
  rig.subsystem.own_loop_step(0, rig.clock.now());
  EXPECT_EQ(rig.events(descriptor::framework_event::service_loop_hangs), 0) << "the whole computer stood";
}

TEST_F(OwnLoops, RefuseWhatThisConfigurationDoesNotOffer) {
  rig.bring_to(State::PreOperational, 2);
  const std::array data{std::byte{1}, std::byte{0}, std::byte{9}};
  const Sent kept = keep(1), housekeeping = rig.send(3, 6, data), values = rig.send(20, 1, data),
             ping = rig.send(17, 1, {}), here = rig.send(201, 1, {});
  rig.settle();
  step_loop();
  EXPECT_EQ(rig.outcome(kept), "2:0006c8");
  EXPECT_EQ(rig.outcome(housekeeping), "2:000603");
  EXPECT_EQ(rig.outcome(values), "2:000614");
  EXPECT_EQ(rig.outcome(ping), "1 3 7");
  EXPECT_EQ(rig.outcome(here), "1 3 7");
  EXPECT_THAT(rig.reports(3, 25), IsEmpty()) << "no structure either";
  rig.set_state_now(State::Offline);
  rig.bring_to(State::PreOperational, 1);
  const Sent again = keep(1);
  rig.settle();
  step_loop();
  EXPECT_EQ(rig.outcome(again), "1 3 7");
}

}  // namespace
}  // namespace hirosco
