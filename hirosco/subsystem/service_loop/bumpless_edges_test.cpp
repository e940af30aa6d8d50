// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/subsystem/testing/inside.hpp"

/// What else is under way while one configuration follows another: a link that two agreed on before it, and nobody who reads explanations.
namespace hirosco {
namespace {

using pus::st128::Role;
using testing::Rig;
using testing::Sent;

constexpr const char* led_descriptor = R"(<Subsystem name="LED" id="10">
  <Configuration name="QUICK" id="1" sampling_us="500">
    <RealTimeLinkService><Requires name="HAND" age="3" required="no"><Field name="ANGLE" type="DOUBLE"/></Requires></RealTimeLinkService>
  </Configuration>
  <Configuration name="SLOW" id="2" sampling_us="1000">
    <RealTimeLinkService><Requires name="HAND" age="3" required="no"><Field name="ANGLE" type="DOUBLE"/></Requires></RealTimeLinkService>
  </Configuration>
  <Bumpless between="QUICK SLOW"/>
</Subsystem>)";

struct Led final : Subsystem {
  struct Angle {
    double angle;
  };
  LinkInput<Angle> hand;
  bool willing{true};

  Result<Step> software_init() override {
    require_link("HAND", hand);
    return done;
  }
  Result<> bumpless(const descriptor::Configuration&, const descriptor::Configuration&,
                    const Cycle&) noexcept override {
    if (!willing) return fail(ErrorCode::NotPermitted, "not now");
    return ok();
  }
};

/// Else a sample would be good for twice as long as the descriptor says.
TEST(LinkIntoABumplessChange, ThatWasAgreedOnInThePeriodBeforeCountsInTheOneInForce) {
  Led author;
  Rig rig{author, led_descriptor};
  rig.bring_to(State::SafeOperational);
  const Sent change = rig.configure(2);
  std::string attached;
  auto hand = rig.attach(1, Role::Consumer, "HAND", {{"ANGLE", Type::Double, 1}}, &attached, 10ms);
  rig.service();
  EXPECT_EQ(rig.outcome(change), "1 3 7");
  EXPECT_EQ(attached, "1 3 7");
  hand.writer.write(std::array<std::byte, 8>{}, rig.clock.now(), LinkStatus::Valid);
  rig.cycle();
  for (int old = 1; old <= 3 * 10; ++old) {
    rig.cycle();
    EXPECT_TRUE(author.hand.valid()) << old;
  }
  rig.cycle();
  EXPECT_FALSE(author.hand.valid()) << "three periods of its producer are over";
}

TEST(UnexplainedBumplessChange, ThatFailsIsReportedThoughNobodyWantsItsExplanation) {
  Led author;
  author.willing = false;
  ManualClock clock;
  HeapMemory memory;
  LocalFlows flows;
  ChannelPair channels{4096};
  VitalPage vital{};
  PermitPage permit{};
  permit.release();
  GenericSubsystem quiet{author,
                         testing::read_descriptor(led_descriptor),
                         {.clock = clock, .memory = memory, .flows = flows},
                         channels.subsystem_end(),
                         vital,
                         permit};
  int failures = 0;
  const auto step = [&] {
    permit.heartbeat.fetch_add(1);
    static_cast<void>(quiet.service_step(clock.now()));
    MessageBuffer buffer;
    for (;;) {
      const auto found = channels.supervisor_end().receive(buffer);
      if (!found || found->flow == Flow::None) break;
      if (found->message.kind != MessageKind::Event) continue;
      const auto event = pus::read_event_message(found->message.packet);
      if (event && event->id == descriptor::framework_event::configuration_failed) ++failures;
    }
    const auto demand = quiet.cycle_demand();
    if (!demand.wanted) return quiet.cycle_parked(demand.ticket);
    clock.advance(demand.period);
    static_cast<void>(quiet.cycle_step(clock.now()));
  };
  const auto call = [&](std::string_view function, double argument) {
    std::array<std::byte, 64> buffer{};
    const auto functions = pus::common_functions();
    const auto data =
        pus::encode_call(*std::ranges::find(functions, function, &descriptor::Function::name), std::array{argument});
    const auto packet = pus::write_telecommand(
        buffer, {.apid = 10, .sequence_count = 1, .ack = pus::ack_all, .service = 8, .subtype = 1, .source = 7}, *data);
    ASSERT_TRUE(channels.supervisor_end().send({.packet = packet.value(), .memory = {}}));
    for (int i = 0; i < 12; ++i) step();
  };
  call("SET_STATE", static_cast<double>(State::PreOperational));
  call("CONFIGURE", 1);
  call("SET_STATE", static_cast<double>(State::SafeOperational));
  ASSERT_EQ(quiet.state(), State::SafeOperational);
  call("CONFIGURE", 2);
  EXPECT_EQ(failures, 1);
  EXPECT_EQ(vital.configuration.load(), 1u);
  author.willing = true;
  call("CONFIGURE", 2);
  EXPECT_EQ(failures, 1);
  EXPECT_EQ(vital.configuration.load(), 2u);
}

}  // namespace
}  // namespace hirosco
