// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/link_slots.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "hirosco/data_transfer/memory/heap_memory.hpp"

namespace hirosco {
namespace {

struct Handed {
  double angle;
};

TEST(LinkSlot, AnInputTakesFieldsOfItsOwnTypeOnlyAndLetsGoOfItsOwnLinkOnly) {
  descriptor::Requires terms;
  terms.fields.resize(1);
  terms.fields[0].name = "ANGLE";
  terms.fields[0].type = Type::Double;
  terms.fields[0].count = 1;
  LinkInput<Handed> port;
  LinkInputSlot slot{terms, &port, true};
  AttachedLink link;
  const auto planned = [&](const char* name, Type type, std::uint16_t count) {
    link.agreement.kind = LinkKind::Latest;
    link.agreement.fields = {{"OTHER", Type::Uint8, 3}, {name, type, count}};
    return slot.plan(link).has_value();
  };
  EXPECT_FALSE(planned("ANGLES", Type::Double, 1));
  EXPECT_FALSE(planned("ANGLE", Type::Float, 1));
  EXPECT_FALSE(planned("ANGLE", Type::Double, 2));
  ASSERT_TRUE(planned("ANGLE", Type::Double, 1));
  ASSERT_EQ(link.wire_offset.size(), 1u);
  EXPECT_EQ(link.wire_offset[0], 3u) << "behind the three octets of the other";
  slot.attach(&link);
  const AttachedLink other;
  slot.detach(&other);
  EXPECT_TRUE(slot.attached());
  slot.detach(&link);
  EXPECT_FALSE(slot.attached());
  EXPECT_TRUE(slot.ended());
  slot.read(TimePoint{}, true);
  EXPECT_TRUE(slot.stale());
}

/// A hand whose producer has a period of 10 ms; a sample may be three of those old.
struct SlotOfAHand : ::testing::Test {
  descriptor::Requires terms = [] {
    descriptor::Requires made;
    made.fields.resize(1);
    made.fields[0].name = "ANGLE";
    made.fields[0].type = Type::Double;
    made.fields[0].count = 1;
    made.age = {3, 30};
    return made;
  }();
  LinkInput<Handed> port;
  LinkInputSlot slot{terms, &port, true};
  HeapMemory memory;
  AttachedLink link;
  std::unique_ptr<LinkWriter> writer;
  TimePoint now{1s};

  void SetUp() override {
    link.agreement = {.method = LinkMethod::SharedMemory,
                      .byte_order = descriptor::ByteOrder::Little,
                      .kind = LinkKind::Latest,
                      .producer_period = 10ms,
                      .consumer_period = 1ms,
                      .fields = {{"ANGLE", Type::Double, 1}}};
    const auto layout = link.agreement.layout(1);
    const auto* mechanism = find_link_mechanism(standard_link_mechanisms(), LinkMethod::SharedMemory, LinkKind::Latest);
    const MemoryHandle shared = mechanism->establish(memory, layout).value();
    writer = mechanism->produce(memory, shared, layout).value();
    link.reader = mechanism->consume(memory, shared, layout).value();
    link.payload.resize(layout.payload_octets);
    link.count_in(1ms);
    ASSERT_TRUE(slot.plan(link));
    slot.attach(&link);
  }
  void sample(Duration latency = {}) {
    writer->write(std::array<std::byte, sizeof(double)>{}, now - latency, LinkStatus::Valid);
    slot.read(now, true);
  }
  [[nodiscard]] Duration jitter() const {
    IncomingLink page{};
    slot.tell(page);
    return Duration{page.jitter_ns.load()};
  }
};

TEST_F(SlotOfAHand, InCyclesOfAnotherPeriodASampleMayBeAsOldAsBefore) {
  for (const auto& [period, cycles] : {std::pair{5ms, 6}, {1ms, 30}, {20ms, 3}}) {
    slot.follow(period);
    sample();
    for (int old = 1; old <= cycles; ++old) {
      slot.read(now, true);
      EXPECT_FALSE(slot.stale()) << period.count() << ' ' << old;
    }
    slot.read(now, true);
    EXPECT_TRUE(slot.stale()) << period.count();
  }
  slot.release();
  slot.follow(1ms);
  EXPECT_EQ(link.producer_cycles_per_sample, 1U) << "whom it let go of it leaves alone";
}

TEST_F(SlotOfAHand, HasItsTurnInCyclesInWhichLimitsGoOnAlone) {
  for (int cycle = 0; cycle < 100; ++cycle) EXPECT_TRUE(slot.awaits_first(true, false)) << cycle;
  for (int cycle = 0; cycle < 30; ++cycle) EXPECT_TRUE(slot.awaits_first(true, true)) << cycle;
  EXPECT_FALSE(slot.awaits_first(true, true));
}

TEST_F(SlotOfAHand, OfTheNextConfigurationBeginsWithNothingOfTheOneBefore) {
  sample();
  ASSERT_TRUE(port.valid());
  const LinkInputSlot next{terms, &port, true};
  EXPECT_FALSE(port.valid());
  EXPECT_EQ(port.status(), LinkStatus::None);
  EXPECT_EQ(port.count(), 0U);
}

/// Of a camera that lends what it has seen.
struct LentSight final : LoanReader {
  std::array<std::byte, sizeof(Handed)> seen{};
  LinkSample newest() noexcept override { return {}; }
  Octets look() noexcept override { return seen; }
  [[nodiscard]] bool whole() const noexcept override { return true; }
  [[nodiscard]] const std::uint32_t* arrival_word() const noexcept override { return nullptr; }
};

TEST(LinkSlot, OfTheNextConfigurationLooksAtNothingThatWasLentToTheOneBefore) {
  descriptor::Requires terms;
  LoanInput<Handed> port;
  LinkInputSlot slot{terms, &port, true};
  AttachedLink link;
  link.borrower = std::make_unique<LentSight>();
  slot.attach(&link);
  ASSERT_NE(port.look(), nullptr);
  ASSERT_TRUE(port.whole());
  const LinkInputSlot next{terms, &port, true};
  EXPECT_EQ(port.look(), nullptr);
  EXPECT_FALSE(port.whole());
}

TEST(LinkSlot, OfAQueueHasNothingBeforeItsFirstCycle) {
  descriptor::Requires terms;
  QueueInput<Handed> port;
  LinkInputSlot slot{terms, &port, true};
  AttachedLink link;
  slot.attach(&link);
  EXPECT_TRUE(port.samples().empty());
}

/// A counter that its own consumers count up: what one of them is given tells how many were given something before it was encoded.
struct CountedUp {
  descriptor::SubsystemDescriptor subsystem;
  descriptor::Provides terms;
  Parameter<std::uint32_t> count;
  Dictionary dictionary;
  struct Consumer final : LinkWriter {
    Consumer(Parameter<std::uint32_t>& counted, std::endian in_order) : count{counted}, order{in_order} {}
    Parameter<std::uint32_t>& count;
    std::endian order;
    std::vector<std::uint32_t> given;
    void write(Octets payload, TimePoint, LinkStatus) noexcept override {
      given.push_back(OctetReader{payload, order}.get<std::uint32_t>());
      count.store(count.load() + 1);
    }
    void set_status(LinkStatus) noexcept override {}
  };

  CountedUp() {
    const ParameterId id{7, Type::Uint32, 1};
    dictionary = *Dictionary::make(
        std::array{ParameterSpec{.name = "COUNT", .id = id, .fields = {{.name = "COUNT", .type = Type::Uint32}}}});
    EXPECT_TRUE(dictionary.publish("COUNT", count));
    descriptor::Parameter declared;
    declared.field.name = "COUNT";
    declared.field.type = Type::Uint32;
    declared.field.count = 1;
    subsystem.parameters = {declared};
    terms.parameters = {{.text = "COUNT", .parameter = 0, .member = std::nullopt, .at = {}}};
  }
};

TEST(LinkSlot, AnOutputIsEncodedOnceForAllConsumersOfAByteOrderHoweverManyThereAre) {
  CountedUp made;
  LinkOutputSlot slot{made.subsystem, made.terms, made.dictionary};
  std::array<AttachedLink, 7> links;
  std::array<const CountedUp::Consumer*, links.size()> consumers{};
  for (std::size_t i = 0; i < links.size(); ++i) {
    links[i].order = i % 3 == 0 ? std::endian::big : std::endian::little;
    auto consumer = std::make_unique<CountedUp::Consumer>(made.count, links[i].order);
    consumers[i] = consumer.get();
    links[i].writer = std::move(consumer);
    slot.attach(&links[i]);
  }
  for (std::size_t cycle = 0; cycle < 2; ++cycle) {
    slot.write(TimePoint{1s}, LinkStatus::Valid);
    std::map<std::endian, std::set<std::uint32_t>> values;
    for (const auto* consumer : consumers) {
      ASSERT_EQ(consumer->given.size(), cycle + 1) << "each is given one sample in a cycle";
      values[consumer->order].insert(consumer->given.back());
    }
    for (const auto& [order, different] : values)
      EXPECT_EQ(different.size(), 1u) << "big: " << (order == std::endian::big);
    const auto fresh = static_cast<std::uint32_t>(cycle * links.size());
    EXPECT_TRUE(values[std::endian::little].contains(fresh) || values[std::endian::big].contains(fresh))
        << "what the cycle has made";
  }
  slot.release();
}

TEST_F(SlotOfAHand, HasNoJitterBeforeItsSecondSample) {
  sample(1600us);
  EXPECT_EQ(jitter(), 0us) << "there is no sample before it";
  sample(800us);
  EXPECT_EQ(jitter(), 50us) << "RFC 3550: a sixteenth of the distance";
  slot.attach(&link);
  sample(1600us);
  EXPECT_EQ(jitter(), 0us) << "what an earlier link brought is not before it";
}

}  // namespace
}  // namespace hirosco
