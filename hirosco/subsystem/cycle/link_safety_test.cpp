// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/subsystem/testing/inside.hpp"
#include "hirosco/subsystem/testing/probe.hpp"

/// What the framework does for safety at real-time links: required ones, stale, lost, damaged and foreign samples, the
/// producer's status (decisions 20 to 22).
namespace hirosco {
namespace {

using pus::st128::Role;
using ::testing::ElementsAre;
using testing::hand_stale;
using testing::Probe;
using testing::probe_descriptor;
using testing::Rig;

const std::vector<pus::st128::OfferedField> hand_fields{{"ANGLE", Type::Double, 1}, {"ENABLE", Type::Uint8, 1}};

/// The test is the producer of HAND.
struct Links : ::testing::Test {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  Rig::Partner hand;

  void SetUp() override { rig.bring_to(State::PreOperational, 2); }
  void couple() { hand = rig.attach(1, Role::Consumer, "HAND", hand_fields); }
  void sample(double angle, LinkStatus status = LinkStatus::Valid) {
    std::array<std::byte, 9> payload{};
    OctetWriter writer{payload, std::endian::little};
    writer.put(angle).put(std::uint8_t{1});
    hand.writer.write(payload, rig.clock.now(), status);
  }
  void go(State state) {
    const auto request = rig.set_state(state);
    for (int i = 0; i < 4; ++i) {
      sample(0.25);
      rig.service();
      rig.cycle();
    }
    rig.service();
    EXPECT_EQ(rig.outcome(request), "1 3 7") << to_text(state);
  }
  void operate() {
    couple();
    go(State::SafeOperational);
    go(State::Operational);
    EXPECT_EQ(rig.inhibited(), 0u);
  }
};

TEST_F(Links, SafeOperationalIsRefusedUntilTheRequiredLinkIsAttached) {
  EXPECT_EQ(rig.set_state_now(State::SafeOperational), "1 4:000e");
  couple();
  EXPECT_EQ(rig.set_state_now(State::SafeOperational), "1 3 7");
}

TEST_F(Links, ASampleReachesTheAuthorInTheNextCycle) {
  couple();
  sample(0.75);
  rig.cycle();
  EXPECT_EQ(probe.hand.value().angle, 0.75);
  EXPECT_EQ(probe.hand.value().enable, 1);
  EXPECT_TRUE(probe.hand.valid());
  EXPECT_EQ(probe.hand.age_cycles(), 0u);
  rig.cycle(2);
  EXPECT_EQ(probe.hand.age_cycles(), 2u);
}

TEST_F(Links, ASampleThatComesAndGoesBetweenTwoCyclesCountsAsLost) {
  couple();
  for (int samples : {1, 3, 0, 1}) {
    for (int i = 0; i < samples; ++i) sample(0.5);
    rig.cycle();
  }
  const LinkStatistics seen = rig.subsystem.cycle().link_statistics().load();
  EXPECT_EQ(seen.received, 3u);
  EXPECT_EQ(seen.lost, 2u);
}

TEST_F(Links, TheVitalPageTellsLossAndLatencyOfEachLink) {
  const IncomingLink& told = rig.vital.incoming[0];
  rig.cycle();
  EXPECT_EQ(told.link.load(), 0u);
  couple();
  sample(0.5);
  rig.cycle();
  EXPECT_EQ(told.link.load(), 1u);
  EXPECT_EQ(told.latency_mean_ns.load(), 1'000'000u);
  sample(0.5);
  rig.advance(500us);
  rig.cycle();
  EXPECT_EQ(told.latency_mean_ns.load(), 1'250'000u);
  rig.cycle();  // the same sample again is no news
  EXPECT_EQ(told.latency_max_ns.load(), 1'500'000u);
  EXPECT_EQ(told.lost.load(), 0u);
  for (int i = 0; i < 3; ++i) sample(0.5);
  rig.cycle();
  EXPECT_EQ(told.lost.load(), 2u);
  rig.detach(1);
  rig.service();
  rig.cycle();
  EXPECT_EQ(told.link.load(), 0u);
}

TEST_F(Links, TheVitalPageCountsLatenciesInBinsOfTheProducersPeriodAndBeginsAnewWithEachLink) {
  const LinkLatencies& told = rig.vital.latencies[0];
  const auto counts = [&] { return std::vector<std::uint32_t>(told.counts.begin(), told.counts.end()); };
  couple();
  rig.cycle();
  ASSERT_EQ(told.period_ns.load(), 1'000'000u);
  EXPECT_THAT(counts(), ElementsAre(0, 0, 0, 0, 0, 0, 0, 0, 0));
  for (const Duration latency :
       std::initializer_list<Duration>{1ms, 1ms, 2ms, 2ms + 1ns, 9ms}) {  // a cycle of the rig is 1 ms
    sample(0.5);
    rig.advance(latency - 1ms);
    rig.cycle();
    rig.cycle();  // the same sample again is no news
  }
  EXPECT_THAT(counts(), ElementsAre(0, 0, 0, 0, 0, 0, 2, 1, 2));
  rig.detach(1);
  rig.service();
  rig.cycle();
  hand = rig.attach(2, Role::Consumer, "HAND", hand_fields);
  rig.cycle();
  EXPECT_EQ(told.period_ns.load(), 1'000'000u);
  EXPECT_THAT(counts(), ElementsAre(0, 0, 0, 0, 0, 0, 0, 0, 0));
}

TEST_F(Links, FieldsAreMatchedByNameWhereverTheProducerPutsThem) {
  hand = rig.attach(1, Role::Consumer, "HAND",
                    {{"MORE", Type::Int32, 2}, {"ENABLE", Type::Uint8, 1}, {"ANGLE", Type::Double, 1}});
  std::array<std::byte, 17> payload{};
  OctetWriter writer{payload, std::endian::little};
  writer.put(std::int32_t{1}).put(std::int32_t{2}).put(std::uint8_t{3}).put(0.5);
  hand.writer.write(payload, rig.clock.now(), LinkStatus::Valid);
  rig.cycle();
  EXPECT_EQ(probe.hand.value().angle, 0.5);
  EXPECT_EQ(probe.hand.value().enable, 3);
}

TEST_F(Links, AStaleRequiredLinkInhibitsAndIsReportedOnce) {
  operate();
  rig.cycle(3);
  EXPECT_EQ(rig.inhibited(), 0u);
  rig.cycle();
  EXPECT_EQ(rig.inhibited(), inhibited_by_link);
  EXPECT_FALSE(probe.last.active);
  rig.cycle(20);
  rig.service();
  EXPECT_THAT(rig.reports(5, 3), ElementsAre("f20000000004"));
  sample(0.5);
  rig.cycle();
  EXPECT_TRUE(probe.hand.valid());
  EXPECT_EQ(rig.inhibited(), inhibited_by_link);  // latched
}

TEST_F(Links, TheVitalPageTellsWhatTheCycleMakesOfTheSetFromItsSilenceToItsReturn) {
  const auto after = [this](int cycles) {
    rig.cycle(cycles);
    return rig.vital.judged[0].load();
  };
  EXPECT_EQ(after(1), link_not_judged) << "nobody controls by what is not there";
  operate();
  EXPECT_EQ(after(3), link_valid);
  EXPECT_EQ(after(1), link_stale);
  sample(0.5);
  EXPECT_EQ(after(1), link_valid) << "what inhibits lasts, what is judged does not";
  sample(0.5, LinkStatus::Fault);
  EXPECT_EQ(after(1), link_stale) << "a fault is no return, however new";
  sample(0.5, LinkStatus::Degraded);
  EXPECT_EQ(after(1), link_valid);
  rig.detach(1);
  rig.settle();
  EXPECT_EQ(after(1), link_stale);
}

TEST_F(Links, TheVitalPageTellsNothingOfASetWhoseFirstSampleIsAwaited) {
  hand = rig.attach(1, Role::Consumer, "HAND", hand_fields, nullptr, 4ms);
  ASSERT_EQ(rig.set_state_now(State::SafeOperational), "1 3 7");
  EXPECT_EQ(rig.vital.judged[0].load(), link_not_judged);
}

TEST_F(Links, ASlowerProducerMayTakeItsOwnPeriods) {
  hand = rig.attach(1, Role::Consumer, "HAND", hand_fields, nullptr, 4ms);
  go(State::SafeOperational);
  sample(0.5);
  rig.cycle();
  rig.cycle(12);
  EXPECT_TRUE(probe.hand.valid());
  rig.cycle();
  EXPECT_FALSE(probe.hand.valid());
}

TEST_F(Links, AProducersFaultInhibitsInTheSameCycle) {
  operate();
  sample(0.5, LinkStatus::Fault);
  rig.cycle();
  EXPECT_EQ(rig.inhibited(), inhibited_by_link);
  rig.service();
  EXPECT_EQ(rig.events(hand_stale), 1);
}

TEST_F(Links, AProducersOrderlyEndInhibitsWithoutAlarm) {
  operate();
  hand.writer.set_status(LinkStatus::Stopping);
  rig.cycle(10);
  rig.service();
  EXPECT_EQ(rig.inhibited(), inhibited_by_link);
  EXPECT_EQ(rig.events(hand_stale), 0);
}

TEST_F(Links, ADegradedProducerIsStillFollowed) {
  operate();
  sample(0.5, LinkStatus::Degraded);
  rig.cycle();
  EXPECT_TRUE(probe.hand.valid());
  EXPECT_EQ(rig.inhibited(), 0u);
}

TEST_F(Links, ADetachedLinkIsReportedAndInhibitsWithoutAlarm) {
  operate();
  const auto request = rig.detach(1);
  rig.settle();
  EXPECT_EQ(rig.outcome(request), "1 3 7");
  EXPECT_THAT(rig.reports(128, 133), ElementsAre("0102"));
  EXPECT_EQ(rig.inhibited(), inhibited_by_link);
  EXPECT_EQ(rig.events(hand_stale), 0);
  const auto again = rig.detach(1);
  rig.settle();
  EXPECT_EQ(rig.outcome(again), "1 4:01010000000001");
}

TEST_F(Links, WhatAnEarlierLinkBroughtIsNoSampleOfTheNext) {
  couple();
  sample(0.5);
  rig.cycle();
  ASSERT_TRUE(probe.hand.valid());
  rig.detach(1);
  rig.settle();
  hand = rig.attach(2, Role::Consumer, "HAND", hand_fields);
  EXPECT_FALSE(probe.hand.valid());
  rig.cycle();
  EXPECT_FALSE(probe.hand.valid());
  sample(0.25);
  rig.cycle();
  EXPECT_TRUE(probe.hand.valid());
}

TEST_F(Links, WhatAnEarlierLinkCountedIsNotCountedForTheNext) {
  couple();
  sample(0.5);
  rig.cycle();
  for (int i = 0; i < 3; ++i) sample(0.5, LinkStatus::Degraded);
  rig.cycle(5);
  const IncomingLink& told = rig.vital.incoming[0];
  ASSERT_EQ(probe.hand.received(), 2u);
  ASSERT_EQ(probe.hand.lost(), 2u);
  ASSERT_EQ(probe.hand.age_cycles(), 4u);
  ASSERT_EQ(probe.hand.status(), LinkStatus::Degraded);
  rig.detach(1);
  rig.service();
  rig.cycle();
  EXPECT_EQ(probe.hand.status(), LinkStatus::None);
  hand = rig.attach(2, Role::Consumer, "HAND", hand_fields);
  EXPECT_EQ(probe.hand.received(), 0u);
  EXPECT_EQ(probe.hand.lost(), 0u);
  EXPECT_EQ(probe.hand.count(), 0u);
  EXPECT_EQ(probe.hand.age_cycles(), 1u);
  EXPECT_EQ(told.link.load(), 2u);
  EXPECT_EQ(told.lost.load(), 0u);
  EXPECT_EQ(told.latency_mean_ns.load(), 0u);
  EXPECT_EQ(told.latency_max_ns.load(), 0u);
}

TEST_F(Links, GiveTheirMemoryBackOnceTheCycleHasLetGoOfThem) {
  couple();
  const auto arm =
      rig.attach(2, Role::Producer, "ARM_STATE", {{"POSITION", Type::Double, 1}, {"SEEN", Type::Double, 1}});
  const auto held = [&] { return std::pair{hand.memory.block().use_count(), arm.memory.block().use_count()}; };
  const auto before = held();
  rig.detach(1);
  rig.detach(2);
  rig.service();
  EXPECT_EQ(held(), before) << "a cycle may be using them";
  rig.cycle();
  rig.service();
  EXPECT_LT(held().first, before.first);
  EXPECT_LT(held().second, before.second);
}

TEST_F(Links, KeepTheirMemoryAsLongAsACycleHangsThoughTheirConfigurationHasEnded) {
  operate();
  const auto before = hand.memory.block().use_count();
  rig.set_state_now(State::SafeOperational);
  rig.set_state(State::PostOperational);
  rig.service();  // the cycle is told to rest, and hangs
  rig.advance(11s);
  for (int i = 0; i < 5; ++i) rig.service();
  EXPECT_THAT(rig.reports(128, 133), ElementsAre("0102"));
  EXPECT_EQ(hand.memory.block().use_count(), before);
  rig.cycle();  // it rests
  rig.service();
  EXPECT_LT(hand.memory.block().use_count(), before);
}

TEST_F(Links, OfAnEarlierConfigurationLeaveNothingBehind) {
  couple();
  sample(0.5);
  rig.cycle(2);
  ASSERT_TRUE(probe.hand.valid());
  rig.set_state_now(State::PostOperational);
  EXPECT_EQ(rig.vital.inhibited.load(), 0u);
  rig.set_state_now(State::PreOperational);
  const auto configured = rig.configure(2);
  rig.service();
  ASSERT_EQ(rig.outcome(configured), "1 3 7");
  EXPECT_FALSE(probe.hand.valid());
  EXPECT_EQ(probe.hand.count(), 0u);
  EXPECT_EQ(probe.hand.age_cycles(), 0u);
  EXPECT_EQ(probe.hand.status(), LinkStatus::None);
  EXPECT_EQ(rig.vital.incoming[0].link.load(), 0u);
  EXPECT_EQ(rig.subsystem.cycle().link_statistics().load().received, 0u);
}

TEST_F(Links, TheMeanOfALatencyIsThatOfAllSamplesWhileTheyAreFew) {
  couple();
  for (const Duration latency : {1ms, 2ms, 3ms, 6ms}) {
    sample(0.5);
    rig.advance(latency - 1ms);
    rig.cycle();
  }
  EXPECT_EQ(rig.vital.incoming[0].latency_mean_ns.load(), 3'000'000u);
  EXPECT_EQ(rig.vital.incoming[0].latency_max_ns.load(), 6'000'000u);
}

TEST_F(Links, AnAgreementThatLacksAFieldIsRefused) {
  std::string outcome;
  rig.attach(1, Role::Consumer, "HAND", {{"ANGLE", Type::Double, 1}}, &outcome);
  EXPECT_EQ(outcome, "1 4:010700");
  ASSERT_EQ(rig.reports(128, 131).size(), 1u);
  EXPECT_EQ(rig.set_state_now(State::SafeOperational), "1 4:000e");
}

TEST_F(Links, AnUnknownSetASecondAttachAndMissingMemoryAreRefused) {
  std::string outcome;
  rig.attach(1, Role::Consumer, "FOOT", hand_fields, &outcome);
  EXPECT_EQ(outcome, "1 4:010700");
  couple();
  rig.attach(1, Role::Consumer, "HAND", hand_fields, &outcome);
  EXPECT_EQ(outcome, "1 4:010700");
  EXPECT_EQ(rig.reports(128, 131).size(), 2u);
}

TEST_F(Links, ASecondOneIntoARequiredSetIsRefusedAndDetachingItLeavesTheFirst) {
  couple();
  std::string outcome;
  auto second = rig.attach(2, Role::Consumer, "HAND", hand_fields, &outcome);
  EXPECT_EQ(outcome, "1 4:010700");
  const auto gone = rig.detach(2);
  rig.settle();
  EXPECT_EQ(rig.outcome(gone), "1 4:01010000000002") << "there is no such link here";
  sample(0.25);
  rig.cycle();
  EXPECT_TRUE(probe.hand.valid());
}

TEST_F(Links, IntoASetThatIsNeededAreMadeInPreOperationalOnly) {
  operate();
  sample(0.25);
  rig.detach(1);
  rig.settle();
  for (const State state : {State::Operational, State::SafeOperational}) {
    if (rig.state() != state) {
      ASSERT_EQ(rig.set_state_now(state), "1 3 7");
    }
    std::string outcome;
    rig.attach(2, Role::Consumer, "HAND", hand_fields, &outcome);
    EXPECT_EQ(outcome, "1 4:010700") << to_text(state);
  }
}

TEST_F(Links, AsManyConsumersOfASetAsThereAreLinksGetItsSamples) {
  couple();
  const std::vector<pus::st128::OfferedField> fields{{"POSITION", Type::Double, 1}, {"SEEN", Type::Double, 1}};
  std::vector<Rig::Partner> partners;
  std::string outcome;
  for (std::uint8_t link = 10; link < 40; ++link) {
    partners.push_back(rig.attach(link, Role::Producer, "ARM_STATE", fields, &outcome));
    EXPECT_EQ(outcome, "1 3 7") << int{link};
  }
  rig.cycle();
  std::array<std::byte, 16> payload{};
  for (auto& partner : partners) EXPECT_EQ(partner.reader.read(payload).flow, Flow::New);
  for (const std::uint8_t first_middle_and_last : std::initializer_list<std::uint8_t>{10, 25, 39})
    rig.detach(first_middle_and_last);
  rig.settle();
  for (auto& partner : partners) partner.reader.read(payload);
  rig.cycle();
  std::vector<int> served;
  for (std::size_t i = 0; i < partners.size(); ++i)
    if (partners[i].reader.read(payload).flow == Flow::New) served.push_back(static_cast<int>(10 + i));
  EXPECT_EQ(served.size(), 27u) << "the others go on";
  EXPECT_THAT(served, ::testing::Not(::testing::Contains(::testing::AnyOf(10, 25, 39))));
}

TEST_F(Links, APartnerThatLeftAndCameBackIsAttachedUnderItsLaterEpoch) {
  operate();
  hand.writer.set_status(LinkStatus::Stopping);
  rig.cycle();
  ++rig.link_epoch;
  std::string outcome;
  hand = rig.attach(1, Role::Consumer, "HAND", hand_fields, &outcome);
  EXPECT_EQ(outcome, "1 3 7");
  sample(0.25);
  rig.cycle();
  EXPECT_TRUE(probe.hand.valid());
  rig.settle();
  EXPECT_TRUE(rig.reports(128, 133).empty()) << "the supervisor has this link as up again";
}

TEST_F(Links, AFieldOfAnotherTypeUnderTheSameNameIsRefused) {
  auto fields = hand_fields;
  ++fields.front().count;
  std::string outcome;
  rig.attach(1, Role::Consumer, "HAND", fields, &outcome);
  EXPECT_EQ(outcome, "1 4:010700");
}

TEST_F(Links, ErrorOperationalOverridesAChangeThatTheCycleHasNotConfirmed) {
  operate();
  const auto to_safe = rig.set_state(State::SafeOperational);
  const auto to_error = rig.set_state(State::ErrorOperational);
  rig.settle();
  EXPECT_EQ(rig.state(), State::ErrorOperational);
  EXPECT_EQ(rig.outcome(to_safe), "1 3 8:0204");
  EXPECT_EQ(rig.outcome(to_error), "1 3 7");
}

TEST_F(Links, ACycleThatHangsDoesNotKeepARequestOpen) {
  operate();
  const auto to_safe = rig.set_state(State::SafeOperational);
  for (int i = 0; i < 3; ++i) {
    rig.service();
    rig.advance(11s);
  }
  rig.service();
  EXPECT_THAT(rig.outcome(to_safe), ::testing::StartsWith("1 3 8:0202"));
}

TEST_F(Links, MemoryWithAFutureWriterIsNotTrusted) {
  const pus::st128::AttachRequest request{.link = 1,
                                          .role = Role::Consumer,
                                          .epoch = 5,
                                          .set = "HAND",
                                          .agreement = {LinkMethod::SharedMemory, descriptor::ByteOrder::Little,
                                                        LinkKind::Latest, 0, 1ms, 1ms, hand_fields}};
  const auto open = rig.memory.create("open", link_memory_octets(request.agreement.payload_octets())).value();
  std::vector<std::byte> buffer(max_packet_octets);
  const std::size_t octets = pus::st128::write_attach_request(buffer, request).value();
  const auto unsealed = rig.send(128, pus::st128::attach, Octets{buffer}.first(octets), open);
  const auto without = rig.send(128, pus::st128::attach, Octets{buffer}.first(octets));
  rig.settle();
  EXPECT_EQ(rig.outcome(unsealed), "1 4:010700");
  EXPECT_EQ(rig.outcome(without), "1 4:010700");
}

TEST_F(Links, AProvidedSetCarriesItsStatusBesideTheValues) {
  couple();
  const std::vector<pus::st128::OfferedField> fields{{"POSITION", Type::Double, 1}, {"SEEN", Type::Double, 1}};
  auto arm = rig.attach(2, Role::Producer, "ARM_STATE", fields);
  std::array<std::byte, 16> payload{};
  const auto status = [&] { return arm.reader.read(payload).status; };
  const auto follow = [&] {
    sample(0.25);
    rig.cycle();
    return status();
  };
  EXPECT_EQ(follow(), LinkStatus::Valid);
  OctetReader values{payload, std::endian::little};
  EXPECT_EQ(values.get<double>(), 0.25 * static_cast<double>(probe.last.count));
  go(State::SafeOperational);
  go(State::Operational);
  EXPECT_EQ(follow(), LinkStatus::Valid);
  rig.permit.fence();
  EXPECT_EQ(follow(), LinkStatus::Degraded);
  rig.set_state_now(State::ErrorOperational);
  EXPECT_EQ(follow(), LinkStatus::Fault);
  rig.set_state_now(State::PostOperational);
  EXPECT_EQ(status(), LinkStatus::Stopping);
  EXPECT_THAT(rig.reports(128, 133), ElementsAre("0102", "0201"));
}

}  // namespace
}  // namespace hirosco
