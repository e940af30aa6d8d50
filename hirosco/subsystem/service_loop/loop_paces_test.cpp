// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/subsystem/author/custom_service.hpp"
#include "hirosco/subsystem/testing/inside.hpp"

/// A loop of services goes at the period and priority of the configuration in force: nothing that waits in it, and nothing that the cycle
/// collects, is lost or told twice where they change (docs/adr/0207).
namespace hirosco {
namespace {

using ::testing::ElementsAre;
using testing::Rig;
using testing::Sent;

constexpr const char* pantry_descriptor = R"(<Subsystem name="PANTRY" id="10">
  <ParamRef name="CYCLES" id="0" type="UINT32"/>
  <CustomService name="PANTRY" type="200">
    <Request name="PUT" subtype="1"><Argument name="BOOK" type="UINT32" minimum="0" maximum="9"/></Request>
  </CustomService>
  <ServiceLoop name="SLOW" period_us="20000" priority="12" budget_us="900" queue="8"/>
  <Service name="PANTRY" loop="SLOW"/><Service name="ST03" loop="SLOW"/>
  <HKService id="9" interval="1"><SampledOnce><ParamRef name="CYCLES"/></SampledOnce></HKService>
  <Configuration name="CALM" id="1" sampling_us="1000"/>
  <Configuration name="EAGER" id="2" sampling_us="1000"><ServiceLoop name="SLOW" period_us="5000" priority="30" budget_us="200"/></Configuration>
  <Configuration name="CLOSED" id="3" sampling_us="1000">
    <Service name="PANTRY" offered="no"/><ServiceLoop name="SLOW" period_us="400000"/></Configuration>
  <Bumpless between="CALM EAGER CLOSED"/>
</Subsystem>)";

struct Pantry final : Subsystem {
  CustomService service{"PANTRY"};
  Parameter<std::uint32_t> cycles;
  std::vector<std::uint32_t> books;
  std::function<void()> during_step;
  bool refuses{false};

  Result<> offline() override {
    service.on_request("PUT", [this](std::uint32_t book) -> Result<> {
      books.push_back(book);
      return ok();
    });
    service.on_step([this](TimePoint) {
      if (during_step) during_step();
    });
    provide(service);
    return ok();
  }
  Result<Step> software_init() override {
    publish("CYCLES", cycles);
    return done;
  }
  Result<> configure(const descriptor::Configuration&) override {
    if (refuses) return fail(ErrorCode::NotPermitted, "not now");
    return ok();
  }
  Result<> bumpless(const descriptor::Configuration&, const descriptor::Configuration&,
                    const Cycle&) noexcept override {
    return ok();
  }
  Result<> safe_operational(const Cycle&) noexcept override {
    cycles.store(cycles.load() + 1);
    return ok();
  }
};

struct LoopPaces : ::testing::Test {
  static constexpr std::uint8_t calm = 1, eager = 2, closed = 3;
  Pantry author;
  Rig rig{author, pantry_descriptor};

  [[nodiscard]] const descriptor::ServiceLoop& pace() const { return rig.subsystem.own_loop(0).in_force(); }
  [[nodiscard]] TimePoint due(TimePoint planned) const { return rig.subsystem.own_loop(0).due(planned); }
  TimePoint step(TimePoint planned) { return rig.own_loop(0, planned); }
  Sent put(std::uint32_t book) {
    std::array<std::byte, 4> data;
    OctetWriter{data}.put(book);
    return rig.send(200, 1, data);
  }
  /// Without a break, and no step of the loop meanwhile; when the service loop knew of it.
  TimePoint follow(std::uint8_t configuration) {
    const Sent sent = rig.configure(configuration);
    rig.service();
    rig.cycle();
    const TimePoint now = rig.clock.now();
    rig.service();
    EXPECT_EQ(rig.outcome(sent), "1 3 7");
    return now;
  }
};

TEST_F(LoopPaces, AreThoseOfTheSubsystemUntilAConfigurationSaysOtherwiseAndAgainBehindIt) {
  EXPECT_EQ(pace().period, 20ms);
  rig.bring_to(State::PreOperational, 0);
  EXPECT_EQ(pace().period, 20ms) << "none is in force";
  EXPECT_EQ(rig.configure_now(eager), "1 3 7");
  EXPECT_EQ(pace().period, 5ms);
  EXPECT_EQ(pace().priority, 30);
  EXPECT_EQ(pace().budget, 200us);
  EXPECT_EQ(pace().queue, 8U);
  const TimePoint next = step(rig.clock.now());
  EXPECT_EQ(step(next), next + 5ms);
  rig.set_state_now(State::Offline);
  EXPECT_EQ(pace().period, 20ms);
  EXPECT_EQ(pace().priority, 12);
  rig.bring_to(State::PreOperational, calm);
  EXPECT_EQ(pace().period, 20ms) << "it says nothing of the loop";
}

TEST_F(LoopPaces, OfAConfigurationThatCannotBeTakenAreNotInForce) {
  author.refuses = true;
  rig.bring_to(State::PreOperational, 0);
  EXPECT_EQ(rig.configure_now(eager).substr(0, 5), "1 3 8");
  EXPECT_EQ(pace().period, 20ms);
}

TEST_F(LoopPaces, ShorterOnesMakeTheNextStepDueSoonerAndLongerOnesLeaveIt) {
  rig.bring_to(State::SafeOperational, calm);
  const TimePoint planned = step(rig.clock.now());
  EXPECT_EQ(due(planned), planned);
  const TimePoint sooner = follow(eager) + 5ms;
  ASSERT_LT(sooner, planned);
  EXPECT_EQ(due(planned), sooner) << "a new period from now";
  const TimePoint next = step(planned);
  EXPECT_EQ(next, sooner + 5ms) << "the grid goes on from there";
  EXPECT_EQ(due(next), next) << "once";
  follow(closed);
  EXPECT_EQ(due(next), next) << "who waits already waits no longer";
  EXPECT_EQ(step(next), next + 400ms);
}

TEST_F(LoopPaces, ShorterOnesPutOffNoStepThatIsDueBefore) {
  rig.bring_to(State::SafeOperational, calm);
  const TimePoint planned = rig.clock.now() + 2ms;
  follow(eager);
  EXPECT_EQ(due(planned), planned);
  EXPECT_EQ(step(planned), planned + 5ms);
}

TEST_F(LoopPaces, ChangeWithoutALossAndWithoutASecondAnswer) {
  rig.bring_to(State::SafeOperational, calm);
  std::vector<Sent> sent{put(1), put(2)};
  follow(eager);
  sent.push_back(put(3));
  rig.service();
  const TimePoint next = step(rig.clock.now());
  sent.push_back(put(4));
  follow(calm);
  step(next);
  rig.service();
  EXPECT_THAT(author.books, ElementsAre(1, 2, 3, 4));
  for (const Sent& each : sent) EXPECT_EQ(rig.outcome(each), "1 3 7");
}

TEST_F(LoopPaces, ChangeWithoutALossOfWhatTheCycleCollects) {
  rig.bring_to(State::SafeOperational, calm);
  rig.settle();
  rig.forget_telemetry();
  for (const std::uint8_t configuration : {eager, calm, eager}) {
    follow(configuration);
    step(rig.clock.now());
    rig.settle();
  }
  std::vector<unsigned long> told;
  for (const std::string& report : rig.reports(3, 25)) {
    ASSERT_EQ(report.substr(0, 4), "0009");
    told.push_back(std::stoul(report.substr(4), nullptr, 16));
  }
  ASSERT_GT(told.size(), 30U);
  for (std::size_t i = 1; i < told.size(); ++i) EXPECT_EQ(told[i], told[i - 1] + 1) << "each cycle once";
}

TEST_F(LoopPaces, StandBesideTheServicesThatTheConfigurationLeavesOut) {
  rig.bring_to(State::SafeOperational, calm);
  const Sent waits = put(1);
  rig.service();
  follow(closed);
  const Sent refused = put(2);
  rig.service();
  step(rig.clock.now());
  rig.service();
  EXPECT_EQ(rig.outcome(waits), "2:0006c8") << "what came before it too";
  EXPECT_EQ(rig.outcome(refused), "2:0006c8");
  EXPECT_TRUE(author.books.empty());
  follow(calm);
  const Sent again = put(3);
  rig.service();
  step(rig.clock.now());
  rig.service();
  EXPECT_EQ(rig.outcome(again), "1 3 7");
}

TEST_F(LoopPaces, SayFromWhenOnAStepHangs) {
  rig.bring_to(State::SafeOperational, closed);
  author.during_step = [&] {
    // The other thread goes on meanwhile: a test has one, so it is stepped from inside.
    for (int i = 0; i < 20; ++i) {
      rig.advance(50ms);
      rig.service();
    }
  };
  step(rig.clock.now());
  EXPECT_EQ(rig.events(descriptor::framework_event::service_loop_hangs), 0) << "a second is less than three periods";
  author.during_step = nullptr;
  rig.set_state_now(State::PostOperational);
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(pace().period, 20ms);
}

}  // namespace
}  // namespace hirosco
