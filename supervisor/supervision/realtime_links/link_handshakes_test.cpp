// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/realtime_links/link_handshakes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/data_transfer/link/latest_link.hpp"
#include "hirosco/data_transfer/link/loaned_link.hpp"
#include "hirosco/data_transfer/link/queued_link.hpp"
#include "supervisor/supervision/testing/handshakes_rig.hpp"

namespace hirosco::supervisor {
namespace {

namespace st128 = pus::st128;
using st128::Role;
using testing::arm;
using testing::camera;
using ::testing::ElementsAre;
using testing::hand;
using ::testing::IsEmpty;
using testing::LinkHandshakesTest;
using enum LinkReleases::Released;

TEST_F(LinkHandshakesTest, TheHandshakeAsksTheConsumerThenTheProducerThenAttachesProducerAndConsumer) {
  ASSERT_TRUE(links.establish(2, now, done()));
  EXPECT_THAT(supervisor.take(), ElementsAre("10<-1"));
  EXPECT_EQ(st128::read_offer_request(supervisor.last)->set, "HAND_STATE");
  offers();
  EXPECT_THAT(supervisor.take(), ElementsAre("11<-2"));
  EXPECT_EQ(st128::read_terms_request(supervisor.last)->consumer.fields, offer.fields);
  agrees();
  EXPECT_THAT(supervisor.take(), ElementsAre("11<-3+"));
  EXPECT_EQ(st128::read_attach_request(supervisor.last)->role, Role::Producer);
  attaches(hand, Role::Producer);
  EXPECT_THAT(supervisor.take(), ElementsAre("10<-3+"));
  EXPECT_EQ(st128::read_attach_request(supervisor.last)->role, Role::Consumer);
  EXPECT_FALSE(links.graph().is_up(2));
  attaches(arm, Role::Consumer);
  EXPECT_TRUE(links.graph().is_up(2));
  EXPECT_THAT(ends, ElementsAre(true));
  EXPECT_THAT(supervisor.changes,
              ElementsAre("2 up: shared_memory, little endian, latest, 2000 Hz to 1000 Hz, 16 octets"));
}

TEST_F(LinkHandshakesTest, BothEndsGetTheSameMemoryOfTheAgreedSizeAndTheSameEpoch) {
  advance(2);
  const auto producers = supervisor.last_memory.block();
  const auto epoch = st128::read_attach_request(supervisor.last)->epoch;
  attaches(hand, Role::Producer);
  EXPECT_EQ(supervisor.last_memory.block(), producers);
  EXPECT_EQ(st128::read_attach_request(supervisor.last)->epoch, epoch);
  EXPECT_TRUE(memory.verify(supervisor.last_memory, link_memory_octets(16), false));
}

TEST_F(LinkHandshakesTest, ALinkIsLookedAtWhileItIsUpAndTellsWhatItsProducerWrote) {
  advance(2);
  const auto attach = *st128::read_attach_request(supervisor.last);
  const LinkLayout layout{.epoch = attach.epoch,
                          .payload_octets = 16,
                          .layout_hash = attach.agreement.layout_hash(),
                          .period = attach.agreement.producer_period};
  auto writer = LatestLink{}.produce(memory, supervisor.last_memory, layout).value();
  writer->write(std::array<std::byte, 16>{}, TimePoint{5ms}, LinkStatus::Valid);
  attaches(hand, Role::Producer);
  EXPECT_FALSE(links.glance(2)) << "not up";
  attaches(arm, Role::Consumer);
  ASSERT_TRUE(links.glance(2));
  EXPECT_EQ(links.glance(2)->count, 1U);
  EXPECT_EQ(links.glance(2)->sampled_at, TimePoint{5ms});
  links.forget(hand);
  EXPECT_FALSE(links.glance(2)) << "nobody looks into what was given back";
}

TEST_F(LinkHandshakesTest, ALinkThatLendsGetsTheMemoryOfItsFourPlaces) {
  advance(1);
  st128::Agreement lent = agreement;
  lent.kind = LinkKind::Loaned;
  lent.fields = {{"NUMBER", Type::Uint64, 1}, {"PIXEL", Type::Uint8, 1'000'000}};
  say(hand, st128::agreement, st128::write_agreement, lent);
  ASSERT_TRUE(supervisor.last_memory);
  EXPECT_TRUE(memory.verify(supervisor.last_memory, loaned_memory_octets(1'000'008), false));
}

TEST_F(LinkHandshakesTest, ALinkThatQueuesGetsTheMemoryOfItsAgreedDepth) {
  advance(1);
  st128::Agreement queued = agreement;
  queued.kind = LinkKind::Queued;
  queued.depth = 100;
  say(hand, st128::agreement, st128::write_agreement, queued);
  ASSERT_TRUE(supervisor.last_memory);
  EXPECT_TRUE(memory.verify(supervisor.last_memory, queued_memory_octets(16, 100), false));
  EXPECT_EQ(st128::read_attach_request(supervisor.last)->agreement.depth, 100U) << "both ends hear of it";
}

TEST_F(LinkHandshakesTest, WhatNoMechanismCarriesIsNotAttached) {
  advance(1);
  supervisor.take();
  auto by_datagrams = agreement;
  by_datagrams.method = LinkMethod::Tipc;
  say(hand, st128::agreement, st128::write_agreement, by_datagrams);
  EXPECT_THAT(supervisor.take(), ::testing::IsEmpty());
  ASSERT_EQ(supervisor.changes.size(), 1U);
  EXPECT_THAT(supervisor.changes.front(), ::testing::StartsWith("2 down: no mechanism here carries tipc"));
  EXPECT_THAT(ends, ElementsAre(false));
}

TEST_F(LinkHandshakesTest, EveryHandshakeHasAnEpochOfItsOwn) {
  advance(4);
  const auto first = st128::read_attach_request(supervisor.last)->epoch;
  links.forget(hand);
  advance(3);
  EXPECT_NE(st128::read_attach_request(supervisor.last)->epoch, first);
}

TEST_F(LinkHandshakesTest, UnknownLinksLinksThatAreUpAndHandshakesUnderWayAreNotBegunAgain) {
  EXPECT_FALSE(links.establish(9, now, done()));
  advance(0);
  EXPECT_FALSE(links.establish(2, now, done()));
  offers();
  agrees();
  attaches(hand, Role::Producer);
  attaches(arm, Role::Consumer);
  EXPECT_FALSE(links.establish(2, now, done()));
  EXPECT_THAT(ends, ElementsAre(true));
}

TEST_F(LinkHandshakesTest, ARefusalEndsTheHandshakeWithItsReason) {
  advance(0);
  refuses(arm);
  EXPECT_THAT(supervisor.changes, ElementsAre("2 down: no such field"));
  EXPECT_THAT(ends, ElementsAre(false));
  EXPECT_TRUE(links.establish(2, now, done()));
}

TEST_F(LinkHandshakesTest, TheOtherPartnerOfARefusedAttachIsDetached) {
  advance(2);
  supervisor.take();
  refuses(hand);
  EXPECT_THAT(supervisor.take(), IsEmpty());
  advance(3);
  supervisor.take();
  refuses(arm);
  EXPECT_THAT(supervisor.take(), ElementsAre("11<-4"));
  EXPECT_THAT(ends, ElementsAre(false, false));
}

/// Whoever was told to attach may still do it after the time limit; then it must let go, or the next try is refused.
TEST_F(LinkHandshakesTest, ATimeLimitAtEveryStageEndsTheHandshakeAndFreesWhoMayBeAttached) {
  const std::vector<std::vector<std::string>> expected{{}, {}, {"11<-4"}, {"10<-4", "11<-4"}};
  for (int stage = 0; stage < 4; ++stage) {
    advance(stage);
    supervisor.take();
    links.step(now + 2s);
    EXPECT_EQ(ends.size(), static_cast<std::size_t>(stage)) << "too early at stage " << stage;
    links.step(now + 8s + 1ms);
    EXPECT_EQ(supervisor.take(), expected[static_cast<std::size_t>(stage)]) << "stage " << stage;
    EXPECT_EQ(ends.size(), static_cast<std::size_t>(stage + 1));
    EXPECT_FALSE(ends.back());
    EXPECT_EQ(supervisor.changes.back(), "2 down: time limit of the handshake");
    now += 1min;
  }
}

TEST_F(LinkHandshakesTest, ATelecommandThatFailsEndsTheHandshakeOfItsStageOnly) {
  struct Sent {
    std::uint16_t apid;
    std::uint8_t subtype;
  };
  const std::array<Sent, 4> sent{
      {{arm, st128::request_offer}, {hand, st128::negotiate_terms}, {hand, st128::attach}, {arm, st128::attach}}};
  for (std::size_t stage = 0; stage < 4; ++stage) {
    ends.clear();
    advance(static_cast<int>(stage));
    for (std::size_t other = 0; other < 4; ++other)
      if (other != stage) links.failed(sent[other].apid, sent[other].subtype, 2, "of another stage");
    for (const std::uint16_t partner : {arm, hand}) links.failed(partner, st128::detach, 2, "of an earlier life");
    links.failed(sent[stage].apid, sent[stage].subtype, 1, "of another link");
    links.step(now);
    EXPECT_THAT(ends, IsEmpty()) << stage;
    links.failed(sent[stage].apid, sent[stage].subtype, 2, "HAND: unknown APID");
    EXPECT_THAT(ends, IsEmpty()) << "not before the step: who asked for it may not have its answer yet";
    links.step(now);
    EXPECT_THAT(ends, ElementsAre(false)) << stage;
    EXPECT_EQ(supervisor.changes.back(), "2 down: HAND: unknown APID");
  }
}

TEST_F(LinkHandshakesTest, AfterTheTimeLimitALateAnswerChangesNothing) {
  advance(3);
  links.step(now + 1min);
  attaches(arm, Role::Consumer);
  EXPECT_FALSE(links.graph().is_up(2));
  EXPECT_THAT(ends, ElementsAre(false));
}

TEST_F(LinkHandshakesTest, TheDeathOfEitherPartnerEndsEveryStage) {
  for (int stage = 0; stage < 4; ++stage)
    for (const std::uint16_t dead : {arm, hand}) {
      advance(stage);
      supervisor.take();
      links.forget(dead);
      ASSERT_FALSE(ends.empty());
      EXPECT_FALSE(ends.back());
      EXPECT_EQ(supervisor.changes.back(), "2 down: a partner is gone");
      for (const auto& command : supervisor.take())
        EXPECT_EQ(command.find(std::to_string(dead) + "<-"), std::string::npos) << command << " to the dead";
      ends.clear();
    }
}

TEST_F(LinkHandshakesTest, TheDeathOfSomebodyElseDisturbsNothing) {
  advance(2);
  links.forget(camera);
  attaches(hand, Role::Producer);
  attaches(arm, Role::Consumer);
  links.forget(camera);
  EXPECT_TRUE(links.graph().is_up(2));
}

TEST_F(LinkHandshakesTest, TheDeathOfAPartnerTakesItsLinksDown) {
  advance(4);
  links.forget(hand);
  EXPECT_FALSE(links.graph().is_up(2));
  EXPECT_EQ(supervisor.changes.back(), "2 down: subsystem 11 is gone");
}

struct ReleaseOfALink : LinkHandshakesTest {
  void SetUp() override {
    advance(4);
    supervisor.take();
    ASSERT_TRUE(links.release(2, on_release()));
    links.step(now);
  }
  void leaves(std::uint16_t end) { detaches(end, end == arm ? Role::Consumer : Role::Producer); }
};

TEST_F(ReleaseOfALink, DetachesTheConsumerFirst) {
  EXPECT_THAT(supervisor.take(), ElementsAre("10<-4", "11<-4"));
  EXPECT_FALSE(links.release(2, on_release()));
}

TEST_F(ReleaseOfALink, EndsWhenBothEndsHaveLetGoAndNotBefore) {
  for (const auto& [first, second] : {std::pair{arm, hand}, std::pair{hand, arm}}) {
    leaves(first);
    links.step(now);
    EXPECT_FALSE(links.graph().is_up(2)) << "of no use from now on";
    EXPECT_THAT(released, IsEmpty());
    leaves(first);
    EXPECT_THAT(released, IsEmpty()) << "the same one twice";
    leaves(second);
    EXPECT_THAT(released, ElementsAre(ByBoth));
    EXPECT_FALSE(links.release(2, on_release())) << "there is nothing left to release";
    released.clear();
    advance(4);
    ASSERT_TRUE(links.release(2, on_release()));
  }
}

TEST_F(ReleaseOfALink, EndsWithTheDeathOfEitherEnd) {
  for (const std::uint16_t dead : {arm, hand})
    for (const bool other_let_go : {false, true}) {
      if (other_let_go) leaves(dead == arm ? hand : arm);
      links.forget(camera);
      EXPECT_THAT(released, IsEmpty());
      links.forget(dead);
      EXPECT_THAT(released, ElementsAre(ByBoth)) << dead << other_let_go;
      released.clear();
      advance(4);
      ASSERT_TRUE(links.release(2, on_release()));
    }
}

TEST_F(ReleaseOfALink, EndsWithTheNextStepWhereTheGraphHasForgottenTheLink) {
  leaves(hand);
  graph.forget(2);
  EXPECT_THAT(released, IsEmpty());
  links.step(now);
  EXPECT_THAT(released, ElementsAre(ByBoth));
}

TEST_F(ReleaseOfALink, FailsOnceAnEndThatHoldsOnRefuses) {
  leaves(arm);
  links.failed(arm, st128::detach, 2, "it has let go already");
  links.failed(hand, st128::detach, 1, "of another link");
  links.failed(hand, st128::attach, 2, "of an earlier handshake");
  links.step(now);
  EXPECT_THAT(released, IsEmpty());
  links.failed(hand, st128::detach, 2, "unknown identifier");
  EXPECT_THAT(released, IsEmpty()) << "not before the step: who asked for it may not have its answer yet";
  links.step(now);
  EXPECT_THAT(released, ElementsAre(Refused));
}

TEST_F(ReleaseOfALink, FailsAtItsTimeLimitWhicheverEndSaysNothing) {
  for (const std::vector<std::uint16_t>& left : {std::vector<std::uint16_t>{}, {arm}, {hand}}) {
    for (const std::uint16_t end : left) leaves(end);
    links.step(now + 2s);
    EXPECT_THAT(released, IsEmpty());
    links.step(now + 2s + 1ns);
    EXPECT_THAT(released, ElementsAre(Unanswered));
    for (const std::uint16_t end : {arm, hand}) leaves(end);
    EXPECT_EQ(released.size(), 1U) << "late answers end nothing twice";
    released.clear();
    advance(4);
    ASSERT_TRUE(links.release(2, on_release()));
    links.step(now);
  }
}

TEST_F(ReleaseOfALink, MayBeAskedForAgainOfTheEndThatStillHoldsOn) {
  leaves(arm);
  links.step(now + 1min);
  EXPECT_THAT(released, ElementsAre(Unanswered));
  supervisor.take();
  ASSERT_TRUE(links.release(2, on_release()));
  EXPECT_THAT(supervisor.take(), ElementsAre("11<-4"));
  leaves(hand);
  EXPECT_THAT(released, ElementsAre(Unanswered, ByBoth));
}

TEST_F(ReleaseOfALink, NoHandshakeOfItBeginsBeforeItHasEndedNorAReleaseInAHandshake) {
  EXPECT_FALSE(links.establish(2, now, done()));
  leaves(arm);
  EXPECT_TRUE(links.releases(2));
  EXPECT_FALSE(links.establish(2, now, done())) << "the other end would refuse it";
  links.step(now + 1min);
  EXPECT_FALSE(links.releases(2));
  EXPECT_TRUE(links.establish(2, now, done()));
  EXPECT_FALSE(links.release(2, on_release()));
}

TEST_F(LinkHandshakesTest, OnlyAnEndOfTheLinkCanReportItDetached) {
  advance(4);
  detaches(camera, Role::Consumer);
  says(arm, st128::detached, Role::Consumer, 9);
  EXPECT_TRUE(links.graph().is_up(2));
  detaches(hand, Role::Producer);
  EXPECT_FALSE(links.graph().is_up(2));
}

TEST_F(LinkHandshakesTest, AProducerThatLeavesBeforeTheConsumerCameEndsTheHandshake) {
  advance(3);
  supervisor.take();
  detaches(hand, Role::Producer);
  EXPECT_THAT(supervisor.take(), ElementsAre("10<-4"));
  attaches(arm, Role::Consumer);
  EXPECT_FALSE(links.graph().is_up(2));
  EXPECT_THAT(ends, ElementsAre(false));
}

/// Both ends report their detachment; the second report may come when its release has failed and the link is made anew.
TEST_F(LinkHandshakesTest, ALateReportOfTheEarlierLifeDoesNotEndANewHandshake) {
  advance(4);
  ASSERT_TRUE(links.release(2, {}));
  detaches(arm, Role::Consumer);
  links.step(now);
  links.step(now + 1min);
  advance(1);
  detaches(hand, Role::Producer);
  agrees();
  attaches(hand, Role::Producer);
  attaches(arm, Role::Consumer);
  EXPECT_TRUE(links.graph().is_up(2));
}

TEST_F(LinkHandshakesTest, AnswersOfTheWrongPartnerOrOutOfTurnAreIgnored) {
  advance(0);
  offers(hand);
  offers(camera);
  agrees();
  attaches(arm, Role::Consumer);
  supervisor.take();
  offers();
  EXPECT_THAT(supervisor.take(), ElementsAre("11<-2"));
  agrees(arm);
  EXPECT_THAT(supervisor.take(), IsEmpty());
  agrees();
  supervisor.take();
  attaches(arm, Role::Producer);
  attaches(arm, Role::Consumer);
  EXPECT_THAT(supervisor.take(), IsEmpty());
  attaches(hand, Role::Producer);
  attaches(hand, Role::Consumer);
  EXPECT_FALSE(links.graph().is_up(2));
  attaches(arm, Role::Consumer);
  EXPECT_TRUE(links.graph().is_up(2));
}

TEST_F(LinkHandshakesTest, DamagedReportsAreIgnored) {
  advance(0);
  report(arm, st128::offer, {});
  report(arm, st128::offer, std::array{std::byte{2}, std::byte{200}});
  report(arm, st128::detached, {});
  EXPECT_TRUE(ends.empty());
  offers();
  EXPECT_EQ(supervisor.sent.back(), "11<-2");
}

}  // namespace
}  // namespace hirosco::supervisor
