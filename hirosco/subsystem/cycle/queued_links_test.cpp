// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <numeric>

#include "hirosco/subsystem/testing/inside.hpp"

/// An encoder at 1 kHz of which an estimator at 100 Hz gets every sample: handshake by ST[128], cycle, loss, death of the producer.
/// The test is the supervisor between them.
namespace hirosco::ticks {
namespace {

namespace st128 = pus::st128;
using st128::Role;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Rig;

constexpr std::uint32_t depth = 16;

constexpr auto encoder_descriptor = R"(<Subsystem name="ENCODER" id="20">
  <Parameters><ParamRef name="NUMBER" id="1" type="UINT64"/><ParamRef name="LEVEL" id="2" type="UINT8"/>
    <ParamRef name="ANGLE" id="3" type="DOUBLE" count="2"/></Parameters>
  <Configuration name="C" id="1" sampling_us="1000"><RealTimeLinkService>
    <Provides name="TICK" kind="latest queued"><ParamRef name="NUMBER"/><ParamRef name="LEVEL"/><ParamRef name="ANGLE"/></Provides>
  </RealTimeLinkService></Configuration></Subsystem>)";

constexpr std::string_view fields_of_tick =
    R"(<Field name="ANGLE" type="DOUBLE" count="2"/><Field name="NUMBER" type="UINT64"/>)";

std::string estimator_descriptor(std::string_view terms = R"(kind="queued" depth="16")",
                                 std::string_view fields = fields_of_tick) {
  return R"(<Subsystem name="ESTIMATOR" id="21"><Configuration name="C" id="1" sampling_us="10000"><RealTimeLinkService>
    <Requires name="TICKS" age="20" )" +
         std::string{terms} + ">" + std::string{fields} +
         "</Requires></RealTimeLinkService></Configuration></Subsystem>";
}

/// Counts its cycles.
struct Encoder final : Subsystem {
  Parameter<std::uint64_t> number;
  Parameter<std::uint8_t> level;
  Parameter<std::array<double, 2>> angle;
  bool fails{false};

 protected:
  Result<Step> software_init() override {
    publish("NUMBER", number);
    publish("LEVEL", level);
    publish("ANGLE", angle);
    return done;
  }
  Result<> pre_operational(const Cycle&) noexcept override { return count(); }
  Result<> safe_operational(const Cycle&) noexcept override { return count(); }
  Result<> operational(const Cycle&) noexcept override { return count(); }

 private:
  Result<> count() noexcept {
    const std::uint64_t next = number.load() + 1;
    number.store(next);
    const auto real = static_cast<double>(next);
    angle.store({0.5 * real, -0.25 * real});
    return fails ? fail(ErrorCode::Internal, "planted") : ok();
  }
};

/// As its consumer sees it: other fields in another order, one of them of a length that comes with the descriptor.
struct Tick {
  Sized<double, 4> angle;
  std::uint64_t number;
};

struct Estimator final : Subsystem {
  QueueInput<Tick> ticks;
  std::vector<std::uint64_t> seen;  ///< in the last cycle
  std::size_t wrong{0};  ///< samples that are not what the encoder made of their number

 protected:
  Result<Step> software_init() override {
    require_link("TICKS", ticks);
    return done;
  }
  Result<> pre_operational(const Cycle&) noexcept override { return take(); }
  Result<> safe_operational(const Cycle&) noexcept override { return take(); }
  Result<> operational(const Cycle&) noexcept override { return take(); }

 private:
  Result<> take() noexcept {
    seen.clear();
    for (const Tick& tick : ticks.samples()) {
      seen.push_back(tick.number);
      const auto real = static_cast<double>(tick.number);
      const bool right = tick.angle.size() == 2 && tick.angle[0] == 0.5 * real && tick.angle[1] == -0.25 * real;
      wrong += right ? 0 : 1;
    }
    return ok();
  }
};

std::vector<std::uint64_t> from_to(std::uint64_t first, std::uint64_t last) {
  std::vector<std::uint64_t> numbers(last - first + 1);
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

struct QueuedLinks : ::testing::Test {
  HeapMemory memory;
  Encoder encoder;
  std::unique_ptr<Rig> encoder_rig = std::make_unique<Rig>(encoder, encoder_descriptor);
  Estimator estimator;
  Rig estimator_rig{estimator, estimator_descriptor()};
  std::array<std::byte, max_packet_octets> buffer{};

  void SetUp() override {
    for (Rig* rig : {encoder_rig.get(), &estimator_rig}) rig->bring_to(State::PreOperational);
  }
  Octets first(const Result<std::size_t>& written) { return Octets{buffer}.first(written.value()); }
  static Octets said(const Rig& rig, std::uint8_t subtype) {
    Octets last;
    for (const auto& report : rig.telemetry)
      if (report.service == st128::service_type && report.subtype == subtype) last = report.data;
    return last;
  }
  /// The supervisor's part of the handshake.
  st128::Agreement agree(Rig& consumer, std::uint8_t link = 1) {
    consumer.send(128, st128::request_offer, first(st128::write_offer_request(buffer, {link, "TICKS"})));
    consumer.settle();
    const auto offer = st128::read_offer(said(consumer, st128::offer)).value();
    encoder_rig->send(128, st128::negotiate_terms,
                      first(st128::write_terms_request(buffer, {link, "TICK", offer.offer})));
    encoder_rig->settle();
    return st128::read_agreement(said(*encoder_rig, st128::agreement)).value().agreement;
  }
  std::string attach(Rig& rig, const st128::AttachRequest& request, const MemoryHandle& shared) {
    const auto sent = rig.send(128, st128::attach, first(st128::write_attach_request(buffer, request)), shared);
    // The request arrives in the service loop, the link in the cycle that follows.
    rig.service();
    rig.cycle();
    rig.service();
    return rig.outcome(sent);
  }
  /// From here on `encoder.number` has been in no sample.
  void couple(Rig& consumer, std::uint8_t link = 1, std::uint32_t epoch = 1) {
    const auto agreement = agree(consumer, link);
    const auto* mechanism = find_link_mechanism(standard_link_mechanisms(), agreement.method, agreement.kind);
    ASSERT_NE(mechanism, nullptr);
    const auto shared = mechanism->establish(memory, agreement.layout(epoch)).value();
    ASSERT_EQ(attach(*encoder_rig, {link, Role::Producer, epoch, "TICK", agreement}, shared), "1 3 7");
    ASSERT_EQ(attach(consumer, {link, Role::Consumer, epoch, "TICKS", agreement}, shared), "1 3 7");
    consumer.cycle();
  }
  void operate() {
    couple(estimator_rig);
    for (const State state : {State::SafeOperational, State::Operational}) {
      encoder_rig->cycle();
      ASSERT_EQ(estimator_rig.set_state_now(state), "1 3 7");
    }
    encoder_rig->cycle();
    estimator_rig.cycle();
    ASSERT_TRUE(estimator.ticks.valid());
    ASSERT_EQ(estimator_rig.inhibited(), 0u);
  }
  std::uint64_t now() { return encoder.number.load(); }
};

TEST_F(QueuedLinks, AreAgreedOnWithTheDepthOfTheirConsumer) {
  const auto agreement = agree(estimator_rig);
  EXPECT_EQ(agreement.kind, LinkKind::Queued);
  EXPECT_EQ(agreement.depth, depth);
  EXPECT_EQ(agreement.payload_octets(), 8u + 1 + 16);
}

TEST_F(QueuedLinks, BringEachSampleOnceOldestFirst) {
  EXPECT_THAT(estimator.ticks.samples(), IsEmpty()) << "no link yet";
  couple(estimator_rig);
  for (int cycle = 0; cycle < 100; ++cycle) {
    const std::uint64_t before = now();
    encoder_rig->cycle(10);
    estimator_rig.cycle();
    ASSERT_EQ(estimator.seen, from_to(before + 1, before + 10));
    EXPECT_EQ(estimator.ticks.age_cycles(), 0u);
    EXPECT_TRUE(estimator.ticks.valid());
  }
  EXPECT_EQ(estimator.wrong, 0u);
  EXPECT_EQ(estimator.ticks.lost(), 0u);
  EXPECT_EQ(estimator.ticks.count(), estimator.ticks.received());
  estimator_rig.cycle();
  EXPECT_THAT(estimator.seen, IsEmpty()) << "none twice";
  EXPECT_EQ(estimator.ticks.age_cycles(), 1u);
  EXPECT_TRUE(estimator.ticks.valid());
}

TEST_F(QueuedLinks, OfAConsumerThatWasAwayTooLongLoseTheOldestAndTellHowMany) {
  couple(estimator_rig);
  std::uint64_t lost = 0;
  for (const std::uint64_t away : {depth - 1, depth, depth + 1, 5 * depth, depth}) {
    encoder_rig->cycle(static_cast<int>(away));
    estimator_rig.cycle();
    const std::uint64_t kept = std::min<std::uint64_t>(away, depth);
    lost += away - kept;
    EXPECT_EQ(estimator.seen, from_to(now() - kept + 1, now()));
    EXPECT_EQ(estimator.ticks.lost(), lost);
    EXPECT_EQ(estimator.ticks.received() + lost, estimator.ticks.count());
  }
  EXPECT_EQ(estimator.wrong, 0u);
  EXPECT_EQ(estimator_rig.vital.incoming[0].lost.load(), lost) << "told on its page";
  EXPECT_EQ(estimator_rig.vital.judged[0].load(), link_valid);
}

TEST_F(QueuedLinks, OfASetThatOthersHaveTheNewestOfBringEachAllTheSame) {
  struct Newest final : Subsystem {
    LinkInput<Tick> ticks;
    Result<Step> software_init() override {
      require_link("TICKS", ticks);
      return done;
    }
  } newest;
  Rig newest_rig{newest, estimator_descriptor(R"(kind="latest")")};
  newest_rig.bring_to(State::PreOperational);
  couple(estimator_rig, 1);
  couple(newest_rig, 2);
  encoder_rig->cycle(10);
  estimator_rig.cycle();
  newest_rig.cycle();
  ASSERT_GE(estimator.seen.size(), 10u);
  EXPECT_EQ(estimator.seen.back(), now());
  EXPECT_EQ(newest.ticks.value().number, now());
}

TEST_F(QueuedLinks, ThatBringNothingAreTooOldAfterTheirAge) {
  operate();
  estimator_rig.cycle(20);
  EXPECT_TRUE(estimator.ticks.valid());
  EXPECT_EQ(estimator_rig.inhibited(), 0u);
  estimator_rig.cycle();
  EXPECT_FALSE(estimator.ticks.valid());
  EXPECT_NE(estimator_rig.inhibited(), 0u);
  encoder_rig->cycle();
  estimator_rig.cycle();
  EXPECT_TRUE(estimator.ticks.valid());
}

TEST_F(QueuedLinks, OfAProducerThatDiesBringWhatItHadFinishedAndGetOld) {
  operate();
  encoder_rig->cycle(5);
  const std::uint64_t last = now();
  encoder_rig.reset();
  estimator_rig.cycle();
  EXPECT_EQ(estimator.seen, from_to(last - 4, last));
  estimator_rig.cycle(21);
  EXPECT_NE(estimator_rig.inhibited(), 0u);
  estimator_rig.service();
  EXPECT_EQ(estimator_rig.heard(descriptor::framework_event::set_stale(0)), 1);
}

TEST_F(QueuedLinks, OfAProducerInFaultAreNotReliedOnThoughGoodSamplesWait) {
  operate();
  encoder_rig->cycle(3);
  encoder.fails = true;
  encoder_rig->cycle();
  estimator_rig.cycle();
  EXPECT_EQ(estimator.seen.size(), 4u);
  EXPECT_EQ(estimator.ticks.status(), LinkStatus::Fault);
  EXPECT_FALSE(estimator.ticks.valid());
  EXPECT_NE(estimator_rig.inhibited(), 0u);
}

TEST_F(QueuedLinks, OfAProducerThatLeavesInOrderEndWithoutAnAlarm) {
  operate();
  ASSERT_EQ(encoder_rig->set_state_now(State::PostOperational), "1 3 7");
  estimator_rig.cycle(100);
  estimator_rig.service();
  EXPECT_EQ(estimator.ticks.status(), LinkStatus::Stopping);
  EXPECT_FALSE(estimator.ticks.valid());
  EXPECT_EQ(estimator_rig.heard(descriptor::framework_event::set_stale(0)), 0);
}

TEST_F(QueuedLinks, TakeTheirSamplesAlongAndALaterOneBeginsWithItsOwn) {
  couple(estimator_rig);
  encoder_rig->cycle(3);
  estimator_rig.cycle();
  ASSERT_EQ(estimator.seen.size(), 3u);
  estimator_rig.detach(1);
  encoder_rig->detach(1);
  encoder_rig->cycle(3);
  encoder_rig->settle();
  estimator_rig.settle();
  EXPECT_THAT(estimator.ticks.samples(), IsEmpty());
  EXPECT_FALSE(estimator.ticks.valid());
  couple(estimator_rig, 1, 2);
  encoder_rig->cycle(2);
  estimator_rig.cycle();
  EXPECT_EQ(estimator.seen, from_to(now() - 1, now()));
  EXPECT_EQ(estimator.wrong, 0u);
  EXPECT_EQ(estimator.ticks.lost(), 0u);
}

/// The one fault among good samples: a producer that reports Fault in one cycle and is well in the next cannot be had from a rig, so the
/// test is the producer.
TEST_F(QueuedLinks, WithOneBadSampleAmongThoseOfACycleAreNotReliedOnInThisCycle) {
  const auto agreement = agree(estimator_rig);
  const auto* queued = find_link_mechanism(standard_link_mechanisms(), agreement.method, agreement.kind);
  const auto shared = queued->establish(memory, agreement.layout(1)).value();
  const auto writer = queued->produce(memory, shared, agreement.layout(1)).value();
  ASSERT_EQ(attach(estimator_rig, {1, Role::Consumer, 1, "TICKS", agreement}, shared), "1 3 7");
  const std::vector<std::byte> payload(agreement.payload_octets());
  for (const LinkStatus status : {LinkStatus::Valid, LinkStatus::Fault, LinkStatus::Valid})
    writer->write(payload, estimator_rig.clock.now(), status);
  estimator_rig.cycle();
  EXPECT_EQ(estimator.seen.size(), 3u);
  EXPECT_EQ(estimator.ticks.status(), LinkStatus::Fault);
  EXPECT_FALSE(estimator.ticks.valid());
  writer->write(payload, estimator_rig.clock.now(), LinkStatus::Valid);
  estimator_rig.cycle();
  EXPECT_EQ(estimator.ticks.status(), LinkStatus::Valid);
  EXPECT_TRUE(estimator.ticks.valid());
}

TEST_F(QueuedLinks, AreNotAttachedAsThoseOfTheNewestSample) {
  auto agreement = agree(estimator_rig);
  agreement.kind = LinkKind::Latest;
  agreement.depth = 0;
  const auto* latest = find_link_mechanism(standard_link_mechanisms(), agreement.method, agreement.kind);
  const auto shared = latest->establish(memory, agreement.layout(1)).value();
  const auto writer = latest->produce(memory, shared, agreement.layout(1)).value();
  EXPECT_EQ(attach(estimator_rig, {1, Role::Consumer, 1, "TICKS", agreement}, shared), "1 4:010700");
}

TEST_F(QueuedLinks, AreNotAttachedWithAnotherDepthThanTheirMemoryHas) {
  auto agreement = agree(estimator_rig);
  const auto* queued = find_link_mechanism(standard_link_mechanisms(), agreement.method, agreement.kind);
  const auto shared = queued->establish(memory, agreement.layout(1)).value();
  const auto writer = queued->produce(memory, shared, agreement.layout(1)).value();
  ++agreement.depth;
  EXPECT_EQ(attach(estimator_rig, {1, Role::Consumer, 1, "TICKS", agreement}, shared), "1 4:010700");
}

TEST(QueuedLinkMistakes, PlacesThatTakeTooMuchMemoryAreNotTaken) {
  struct Wide {
    Sized<double, 8192> angle;
  };
  struct Hoarder final : Subsystem {
    QueueInput<Wide> ticks;
    Result<Step> software_init() override {
      require_link("TICKS", ticks);
      return done;
    }
  } hoarder;
  Rig rig{hoarder, estimator_descriptor(R"(kind="queued" depth="4096")", R"(<Field name="ANGLE" type="DOUBLE"/>)")};
  rig.bring_to(State::PreOperational);
  const st128::Agreement agreement{
      LinkMethod::SharedMemory,    descriptor::ByteOrder::Little, LinkKind::Queued, 4096, 1ms, 10ms,
      {{"ANGLE", Type::Double, 1}}};
  HeapMemory memory;
  const auto* queued = find_link_mechanism(standard_link_mechanisms(), agreement.method, agreement.kind);
  const auto shared = queued->establish(memory, agreement.layout(1)).value();
  const auto writer = queued->produce(memory, shared, agreement.layout(1)).value();
  std::array<std::byte, max_packet_octets> buffer{};
  const auto octets = st128::write_attach_request(buffer, {1, Role::Consumer, 1, "TICKS", agreement}).value();
  const auto sent = rig.send(128, st128::attach, Octets{buffer}.first(octets), shared);
  rig.settle();
  EXPECT_EQ(rig.outcome(sent), "1 4:010700");
}

TEST(QueuedLinkMistakes, APortOfAnotherKindIsNoneOfThisSet) {
  struct Newest final : Subsystem {
    LinkInput<Tick> ticks;
    Result<Step> software_init() override {
      require_link("TICKS", ticks);
      return done;
    }
  } newest;
  Rig newest_rig{newest, estimator_descriptor()};
  EXPECT_THAT(newest_rig.set_state_now(State::PreOperational), HasSubstr("8:"));
  EXPECT_THAT(newest_rig.explanations, ElementsAre(HasSubstr("TICKS: is queued, its port is no QueueInput")));
  Estimator all;
  Rig all_rig{all, estimator_descriptor(R"(kind="latest")")};
  EXPECT_THAT(all_rig.set_state_now(State::PreOperational), HasSubstr("8:"));
  EXPECT_THAT(all_rig.explanations, ElementsAre(HasSubstr("TICKS: is copied, its port is no LinkInput")));
}

}  // namespace
}  // namespace hirosco::ticks
