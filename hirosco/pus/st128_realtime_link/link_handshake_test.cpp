// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st128_realtime_link/link_handshake.hpp"

#include <gtest/gtest.h>

#include <random>

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/testing/vectors.hpp"

namespace hirosco::pus::st128 {
namespace {
using namespace testing;
using descriptor::ByteOrder;

constexpr auto shm = LinkMethod::SharedMemory;
constexpr auto little = ByteOrder::Little;
constexpr auto big = ByteOrder::Big;
constexpr auto latest = LinkKind::Latest;
constexpr auto queued = LinkKind::Queued;
constexpr auto loaned = LinkKind::Loaned;

struct Side {
  std::vector<LinkMethod> methods{shm};
  std::vector<ByteOrder> orders{little};
  std::vector<LinkKind> kinds{latest};
  int period_us{1000};
  std::vector<OfferedField> fields{{"POSITION", Type::Double, 2}};
  std::uint32_t depth{0};
  bool wakes{false};
};

Offer offer_of(const Side& side) {
  return {"SET",
          std::chrono::microseconds{side.period_us},
          {side.methods, side.orders, side.kinds},
          side.depth,
          side.fields,
          side.wakes};
}

/// "shared_memory little latest 1000/1000", or the refusal as "item: text".
std::string outcome(const Side& producer, const Side& consumer) {
  const auto result =
      negotiate(offer_of(producer), offer_of(consumer), [](LinkMethod, LinkKind, bool) { return true; });
  if (!result) return std::to_string(result.error().item) + ": " + result.error().text;
  EXPECT_EQ(result->fields, producer.fields) << "the layout is the producer's";
  return std::string{to_text(result->method)} + " " + std::string{to_text(result->byte_order)} + " " +
         std::string{to_text(result->kind)} + (result->depth == 0 ? "" : "*" + std::to_string(result->depth)) +
         (result->wakes ? "!" : "") + " " + std::to_string(result->producer_period / 1us) + "/" +
         std::to_string(result->consumer_period / 1us);
}

struct Case {
  Side producer;
  Side consumer;
  const char* expected;
};

const std::vector<OfferedField> position{{"POSITION", Type::Double, 2}};
const std::vector<OfferedField> position_and_torque{{"POSITION", Type::Double, 2}, {"TORQUE", Type::Float, 1}};

TEST(LinkHandshake, DecidesEveryPairOfOffersAsWrittenHere) {
  const Case table[] = {
      // Methods: the first of the producer's list that the consumer has.
      {{}, {}, "shared_memory little latest 1000/1000"},
      {{.methods = {LinkMethod::Udp, shm}}, {.methods = {shm, LinkMethod::Udp}}, "udp little latest 1000/1000"},
      {{.methods = {shm, LinkMethod::Udp}},
       {.methods = {LinkMethod::Udp, shm}},
       "shared_memory little latest 1000/1000"},
      {{.methods = {LinkMethod::Dds, LinkMethod::Tcp}},
       {.methods = {shm, LinkMethod::Tcp}},
       "tcp little latest 1000/1000"},
      {{.methods = {LinkMethod::Tipc}},
       {.methods = {LinkMethod::Unix, LinkMethod::Tipc}},
       "tipc little latest 1000/1000"},
      {{.methods = {LinkMethod::Udp}}, {}, "0: method: consumer shared_memory, producer udp"},
      {{.methods = {LinkMethod::Udp, LinkMethod::Tcp}},
       {.methods = {shm, LinkMethod::Dds}},
       "0: method: consumer shared_memory, dds, producer udp, tcp"},
      {{.methods = {}}, {}, "0: method: consumer shared_memory, producer none"},
      // Byte orders.
      {{.orders = {big}}, {.orders = {big}}, "shared_memory big latest 1000/1000"},
      {{.orders = {big, little}}, {.orders = {little, big}}, "shared_memory big latest 1000/1000"},
      {{.orders = {big, little}}, {.orders = {little}}, "shared_memory little latest 1000/1000"},
      {{.orders = {little}}, {.orders = {big}}, "1: byte order: consumer big, producer little"},
      {{.orders = {big}}, {.orders = {little}}, "1: byte order: consumer little, producer big"},
      // Kinds.
      {{.kinds = {queued, latest}},
       {.kinds = {latest, queued}, .depth = 64},
       "shared_memory little queued*64 1000/1000"},
      {{.kinds = {queued, latest}}, {.kinds = {latest}}, "shared_memory little latest 1000/1000"},
      {{.kinds = {latest, queued}}, {.kinds = {latest, queued}, .depth = 64}, "shared_memory little latest 1000/1000"},
      {{.kinds = {latest}}, {.kinds = {queued}}, "2: kind: consumer queued, producer latest"},
      // Rates: an integer ratio either way.
      {{.period_us = 1000}, {.period_us = 5000}, "shared_memory little latest 1000/5000"},
      {{.period_us = 5000}, {.period_us = 1000}, "shared_memory little latest 5000/1000"},
      {{.period_us = 500}, {.period_us = 2000}, "shared_memory little latest 500/2000"},
      {{.period_us = 2000}, {.period_us = 3000}, "3: rate: consumer 3000000 ns, producer 2000000 ns"},
      {{.period_us = 1500}, {.period_us = 1000}, "3: rate: consumer 1000000 ns, producer 1500000 ns"},
      {{.period_us = 0}, {.period_us = 1000}, "3: rate: consumer 1000000 ns, producer 0 ns"},
      {{.period_us = 1000}, {.period_us = 0}, "3: rate: consumer 0 ns, producer 1000000 ns"},
      {{.period_us = -1000}, {.period_us = 1000}, "3: rate: consumer 1000000 ns, producer -1000000 ns"},
      // Fields: all of the consumer's, by name, with type and count; the producer may have more, in any order.
      {{.fields = position_and_torque}, {.fields = position}, "shared_memory little latest 1000/1000"},
      {{.fields = position_and_torque},
       {.fields = {{"TORQUE", Type::Float, 1}, {"POSITION", Type::Double, 2}}},
       "shared_memory little latest 1000/1000"},
      {{.fields = position}, {.fields = {}}, "shared_memory little latest 1000/1000"},
      {{.fields = position}, {.fields = position_and_torque}, "4: field TORQUE: consumer FLOAT, producer has none"},
      {{.fields = position},
       {.fields = {{"POSITION", Type::Float, 2}}},
       "4: field POSITION: consumer FLOAT[2], producer DOUBLE[2]"},
      {{.fields = position},
       {.fields = {{"POSITION", Type::Double, 1}}},
       "4: field POSITION: consumer DOUBLE, producer DOUBLE[2]"},
      {{.fields = position},
       {.fields = {{"position", Type::Double, 2}}},
       "4: field position: consumer DOUBLE[2], producer has none"},
      {{.fields = position_and_torque},
       {.fields = {{"TORQUE", Type::Uint32, 1}, {"FORCE", Type::Double, 1}}},
       "4: field TORQUE: consumer UINT32, producer FLOAT"},
      {{.fields = {}}, {.fields = {}}, "4: payload of 0 octets"},
      {{.fields = {{"BIG", Type::Double, 8193}}}, {.fields = {}}, "4: payload of 65544 octets"},
      {{.fields = {{"BIG", Type::Double, 8192}}}, {.fields = {}}, "shared_memory little latest 1000/1000"},
      // Lent: the same fields in the same order, the machine's byte order, a limit of its own.
      {{.kinds = {loaned}}, {.kinds = {loaned}}, "shared_memory little loaned 1000/1000"},
      {{.kinds = {loaned}}, {.kinds = {latest}}, "2: kind: consumer latest, producer loaned"},
      {{.orders = {big}, .kinds = {loaned}},
       {.orders = {big}, .kinds = {loaned}},
       "1: byte order: a lent sample has the machine's, not big"},
      {{.kinds = {loaned}, .fields = position_and_torque},
       {.kinds = {loaned}, .fields = position},
       "4: fields of a lent sample: the same ones in the same order"},
      {{.kinds = {loaned}, .fields = position_and_torque},
       {.kinds = {loaned}, .fields = {position_and_torque[1], position_and_torque[0]}},
       "4: fields of a lent sample: the same ones in the same order"},
      {{.kinds = {loaned}, .fields = {{"BIG", Type::Uint8, 1U << 24}}},
       {.kinds = {loaned}, .fields = {{"BIG", Type::Uint8, 1U << 24}}},
       "shared_memory little loaned 1000/1000"},
      {{.kinds = {loaned}, .fields = {{"BIG", Type::Uint8, (1U << 24) + 1}}},
       {.kinds = {loaned}, .fields = {{"BIG", Type::Uint8, (1U << 24) + 1}}},
       "4: payload of 16777217 octets"},
      {{.kinds = {loaned}, .fields = {{"BIG", Type::Double, 0xFFFF'FFFF}}},
       {.kinds = {loaned}, .fields = {{"BIG", Type::Double, 0xFFFF'FFFF}}},
       "4: payload of 34359738360 octets"},
      // Every sample: as many are kept as the consumer says, what the producer thinks of it is nothing.
      {{.kinds = {queued}, .depth = 9}, {.kinds = {queued}, .depth = 2}, "shared_memory little queued*2 1000/1000"},
      {{.kinds = {queued}}, {.kinds = {queued}, .depth = 4096}, "shared_memory little queued*4096 1000/1000"},
      {{.kinds = {queued}}, {.kinds = {queued}, .depth = 4097}, "5: depth: 4097 samples of 16 octets"},
      {{.kinds = {queued}}, {.kinds = {queued}, .depth = 1}, "5: depth: 1 samples of 16 octets"},
      {{.kinds = {queued}, .fields = {{"BIG", Type::Double, 8192}}},
       {.kinds = {queued}, .fields = {}, .depth = 1024},
       "shared_memory little queued*1024 1000/1000"},
      {{.kinds = {queued}, .fields = {{"BIG", Type::Double, 8192}}},
       {.kinds = {queued}, .fields = {}, .depth = 1025},
       "5: depth: 1025 samples of 65536 octets"},
      {{.kinds = {queued}, .fields = {{"BIG", Type::Double, 8193}}},
       {.kinds = {queued}, .fields = {}, .depth = 2},
       "4: payload of 65544 octets"},
      // Several reasons: the first in the order of the terms is told.
      {{.methods = {LinkMethod::Udp}, .orders = {big}, .period_us = 3000},
       {.period_us = 2000},
       "0: method: consumer shared_memory, producer udp"},
      {{.orders = {big}, .period_us = 3000}, {.period_us = 2000}, "1: byte order: consumer little, producer big"},
      {{.period_us = 3000, .fields = position},
       {.period_us = 2000, .fields = position_and_torque},
       "3: rate: consumer 2000000 ns, producer 3000000 ns"},
      {{.period_us = 3000}, {.period_us = 2000, .wakes = true}, "shared_memory little latest! 3000/2000"},
      {{.kinds = {queued}}, {.kinds = {queued}, .depth = 8, .wakes = true}, "shared_memory little queued*8! 1000/1000"},
  };
  static_assert(std::size(table) >= 25);
  for (const auto& row : table) EXPECT_EQ(outcome(row.producer, row.consumer), row.expected);
}

Agreement agreement() {
  return {shm, little, latest, 0, 1ms, 5ms, {{"POSITION", Type::Double, 2}, {"ENABLE", Type::Uint8, 1}}};
}
Offer full_offer() {
  return {"JOINTS", 1ms, {{shm, LinkMethod::Udp}, {big, little}, {queued, latest}}, 300, agreement().fields, true};
}

TEST(LinkHandshake, ChoosesMethodAndKindTogetherByWhatIsCarried) {
  const Side both{.methods = {LinkMethod::Udp, shm}, .kinds = {queued, latest}, .depth = 64};
  const auto way = [&](const Carried& carried) {
    const auto result = negotiate(offer_of(both), offer_of(both), carried);
    return result ? std::string{to_text(result->method)} + " " + std::string{to_text(result->kind)}
                  : result.error().text;
  };
  EXPECT_EQ(way([](LinkMethod, LinkKind, bool) { return true; }), "udp queued");
  EXPECT_EQ(way([](LinkMethod method, LinkKind, bool) { return method == shm; }), "shared_memory queued");
  EXPECT_EQ(way([](LinkMethod, LinkKind kind, bool) { return kind == latest; }), "udp latest");
  EXPECT_EQ(way([](LinkMethod method, LinkKind kind, bool) { return method == shm && kind == latest; }),
            "shared_memory latest");
  EXPECT_EQ(way([](LinkMethod, LinkKind, bool) { return false; }),
            "method and kind: nothing here carries what both sides know, as udp with queued");
}

TEST(LinkAgreement, HasThePayloadOfItsPackedFields) { EXPECT_EQ(agreement().payload_octets(), 17U); }

TEST(LinkAgreement, HasAHashThatAllOfItsLayoutChanges) {
  const std::uint64_t hash = agreement().layout_hash();
  EXPECT_EQ(agreement().layout_hash(), hash);
  const auto changed = [](auto change) {
    Agreement other = agreement();
    change(other);
    return other.layout_hash();
  };
  EXPECT_NE(changed([](Agreement& a) { a.byte_order = big; }), hash);
  EXPECT_NE(changed([](Agreement& a) { a.kind = queued; }), hash);
  EXPECT_NE(changed([](Agreement& a) { a.fields[0].name = "POSITIOM"; }), hash);
  EXPECT_NE(changed([](Agreement& a) { a.fields[1].type = Type::Int8; }), hash);
  EXPECT_NE(changed([](Agreement& a) { a.fields[0].count = 3; }), hash);
  EXPECT_NE(changed([](Agreement& a) { std::swap(a.fields[0], a.fields[1]); }), hash);
  EXPECT_NE(changed([](Agreement& a) { a.fields.pop_back(); }), hash);
  EXPECT_EQ(changed([](Agreement& a) { a.method = LinkMethod::Udp; }), hash) << "the way is no part of the layout";
}

TEST(LinkAgreement, ALentSampleLiesAsCppLaysIt) {
  struct Sample {
    std::uint8_t a;
    double b;
    std::array<std::uint16_t, 3> c;
    std::uint8_t d;
  };
  Agreement lent{shm,
                 little,
                 loaned,
                 0,
                 1ms,
                 1ms,
                 {{"A", Type::Uint8, 1}, {"B", Type::Double, 1}, {"C", Type::Uint16, 3}, {"D", Type::Uint8, 1}}};
  EXPECT_EQ(lent.payload_octets(), sizeof(Sample));
  const auto hash = lent.layout_hash();
  lent.kind = latest;
  EXPECT_EQ(lent.payload_octets(), 16u) << "packed";
  EXPECT_NE(lent.layout_hash(), hash);
}

TEST(LinkAgreement, IsWhatAllMakeTheirPartOfTheLinkOf) {
  Agreement agreed = agreement();
  agreed.kind = queued;
  agreed.depth = 70;
  const LinkLayout layout = agreed.layout(9);
  EXPECT_EQ(layout.epoch, 9u);
  EXPECT_EQ(layout.payload_octets, 17u);
  EXPECT_EQ(layout.layout_hash, agreed.layout_hash());
  EXPECT_EQ(layout.period, 1ms);
  EXPECT_EQ(layout.depth, 70u);
}

TEST(LinkMessages, HaveTheOctetsWrittenHere) {
  Bytes buffer(256);
  const Offer offer{"AB", 1ms, {{shm, LinkMethod::Udp}, {little}, {queued}}, 258, {{"P", Type::Double, 2}}, true};
  const auto used = write_terms_request(buffer, {7, "CD", offer});
  EXPECT_EQ(to_hex(Octets{buffer}.first(used.value())),
            "07"
            "024344"
            "07"
            "024142"
            "00000000000f4240"
            "020102"
            "0101"
            "0102"
            "0102"
            "01"
            "01"
            "0150"
            "0a"
            "00000002");
  const auto refused = write_refusal(buffer, 7, {4, "field P"});
  EXPECT_EQ(to_hex(Octets{buffer}.first(refused.value())),
            "07"
            "04"
            "07"
            "6669656c642050");
}

/// Every message: written once, read again by `read`, refused at every truncation and with an octet too many, and
/// survived with every octet damaged.
template <class Read>
void sweep(const Bytes& message, Read read) {
  ASSERT_TRUE(read(Octets{message}).has_value());
  for (std::size_t length = 0; length < message.size(); ++length) {
    const Bytes cut(message.begin(), message.begin() + static_cast<std::ptrdiff_t>(length));
    const auto result = read(Octets{cut});
    ASSERT_FALSE(result.has_value()) << length;
    EXPECT_EQ(result.error().code, ErrorCode::Malformed);
  }
  Bytes longer = message;
  longer.emplace_back();
  EXPECT_FALSE(read(Octets{longer}).has_value());
  for (std::size_t at = 0; at < message.size(); ++at)
    for (const unsigned value : {0x00U, 0x01U, 0x7FU, 0x80U, 0xFFU}) {
      Bytes damaged = message;
      damaged[at] = static_cast<std::byte>(value);
      std::ignore = read(Octets{damaged});
    }
}

template <class Write>
Bytes written(Write write) {
  Bytes buffer(1024);
  const Result<std::size_t> used = write(MutableOctets{buffer});
  EXPECT_TRUE(used.has_value());
  buffer.resize(used.value_or(0));
  // No room is said, whatever the room.
  for (std::size_t room = 0; room < buffer.size(); ++room) {
    Bytes small(room);
    EXPECT_EQ(write(MutableOctets{small}).error().code, ErrorCode::ResourceExhausted) << room;
  }
  return buffer;
}

void expect_equal(const Offer& a, const Offer& b) {
  EXPECT_EQ(a.set, b.set);
  EXPECT_EQ(a.period, b.period);
  EXPECT_EQ(a.terms.methods, b.terms.methods);
  EXPECT_EQ(a.terms.byte_orders, b.terms.byte_orders);
  EXPECT_EQ(a.terms.kinds, b.terms.kinds);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.wakes, b.wakes);
  EXPECT_EQ(a.fields, b.fields);
}
void expect_equal(const Agreement& a, const Agreement& b) {
  EXPECT_EQ(a.method, b.method);
  EXPECT_EQ(a.byte_order, b.byte_order);
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.wakes, b.wakes);
  EXPECT_EQ(a.producer_period, b.producer_period);
  EXPECT_EQ(a.consumer_period, b.consumer_period);
  EXPECT_EQ(a.fields, b.fields);
  EXPECT_EQ(a.layout_hash(), b.layout_hash());
}

TEST(LinkMessages, AreReadAsTheyWereWritten) {
  const Bytes offer_data = written([](MutableOctets to) { return write_offer(to, 3, full_offer()); });
  sweep(offer_data, read_offer);
  EXPECT_EQ(read_offer(offer_data)->link, 3);
  expect_equal(read_offer(offer_data)->offer, full_offer());

  const Bytes agreement_data = written([](MutableOctets to) { return write_agreement(to, 4, agreement()); });
  sweep(agreement_data, read_agreement);
  EXPECT_EQ(read_agreement(agreement_data)->link, 4);
  expect_equal(read_agreement(agreement_data)->agreement, agreement());

  const Bytes refusal_data = written([](MutableOctets to) { return write_refusal(to, 5, {3, "rate"}); });
  sweep(refusal_data, read_refusal);
  EXPECT_EQ(read_refusal(refusal_data)->refusal.item, 3);
  EXPECT_EQ(read_refusal(refusal_data)->refusal.text, "rate");

  const Bytes request = written([](MutableOctets to) { return write_offer_request(to, {6, "JOINTS"}); });
  sweep(request, read_offer_request);
  EXPECT_EQ(read_offer_request(request)->set, "JOINTS");

  const Bytes terms = written([](MutableOctets to) { return write_terms_request(to, {7, "JOINTS", full_offer()}); });
  sweep(terms, read_terms_request);
  EXPECT_EQ(read_terms_request(terms)->link, 7);
  expect_equal(read_terms_request(terms)->consumer, full_offer());

  Agreement of_a_queue = agreement();
  of_a_queue.kind = queued;
  of_a_queue.depth = 300;
  of_a_queue.wakes = true;
  const LinkRoute route{.link = 8, .producer = "192.0.2.1:4000", .consumer = "::1", .key = 0xFEED'BEEF'0123'4567};
  const AttachRequest attach_request{8, Role::Consumer, 0xDEADBEEF, "JOINTS", of_a_queue, route};
  const Bytes attach_data = written([&](MutableOctets to) { return write_attach_request(to, attach_request); });
  sweep(attach_data, read_attach_request);
  EXPECT_EQ(read_attach_request(attach_data)->role, Role::Consumer);
  EXPECT_EQ(read_attach_request(attach_data)->epoch, 0xDEADBEEF);
  expect_equal(read_attach_request(attach_data)->agreement, of_a_queue);
  EXPECT_EQ(read_attach_request(attach_data)->route, route);
  EXPECT_EQ(read_attach_request(attach_data)->header_epoch(), 0xDEADBEEF);

  const Bytes attached_data = written([&](MutableOctets to) {
    return write_attached(to,
                          {.role = Role::Producer, .route = {.link = 8, .producer = "::1", .consumer = {}, .key = 5}});
  });
  sweep(attached_data, read_attached);
  EXPECT_EQ(read_attached(attached_data)->route.producer, "::1");
  EXPECT_EQ(read_attached(attached_data)->route.key, 5u);

  const Bytes reach_data = written([&](MutableOctets to) { return write_reach_request(to, {8, 3, "::1"}); });
  sweep(reach_data, read_reach_request);
  EXPECT_EQ(read_reach_request(reach_data)->consumer, "::1");
}

TEST(LinkMessages, CarryTheConsumersOfferWhole) {
  // The supervisor copies TM[128,129] behind link id and set name without looking at it.
  Bytes buffer(256);
  const auto used = write_offer(buffer, 9, full_offer());
  Bytes relayed = from_hex(
      "09"
      "0343"
      "4d44");
  relayed.insert(relayed.end(), buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(used.value()));
  const auto terms = read_terms_request(relayed);
  ASSERT_TRUE(terms.has_value());
  EXPECT_EQ(terms->set, "CMD");
  expect_equal(terms->consumer, full_offer());
  relayed[0] = std::byte{8};
  EXPECT_FALSE(read_terms_request(relayed).has_value()) << "an offer for another link";
}

TEST(LinkMessages, WithMeaninglessContentAreRefused) {
  const auto bad = [](auto change) {
    Offer offer = full_offer();
    change(offer);
    Bytes buffer(4096);
    const auto used = write_offer(buffer, 1, offer);
    return used.has_value() && !read_offer(Octets{buffer}.first(*used)).has_value();
  };
  EXPECT_FALSE(bad([](Offer&) {}));
  EXPECT_TRUE(bad([](Offer& o) { o.set.clear(); }));
  EXPECT_TRUE(bad([](Offer& o) { o.set = "caf\xC3\xA9"; }));
  EXPECT_TRUE(bad([](Offer& o) { o.period = 0ns; }));
  EXPECT_TRUE(bad([](Offer& o) { o.terms.methods.clear(); }));
  EXPECT_TRUE(bad([](Offer& o) { o.terms.methods[0] = LinkMethod{77}; }));
  EXPECT_TRUE(bad([](Offer& o) { o.terms.kinds[0] = LinkKind{0}; }));
  EXPECT_TRUE(bad([](Offer& o) { o.fields.clear(); }));
  EXPECT_TRUE(bad([](Offer& o) { o.fields[0].type = Type::Struct; }));
  EXPECT_TRUE(bad([](Offer& o) { o.fields[0].count = 0; }));
  EXPECT_TRUE(bad([](Offer& o) { o.fields[1].name = o.fields[0].name; }));
  EXPECT_TRUE(bad([](Offer& o) { o.depth = 1; }));
  EXPECT_TRUE(bad([](Offer& o) { o.terms.kinds = {latest}; })) << "a depth of nothing";
  EXPECT_FALSE(bad([](Offer& o) { o.depth = max_link_depth; }));
}

TEST(LinkMessages, WithADepthThatNoKindHasOrThatTakesTooMuchAreRefused) {
  const auto good = [](LinkKind kind, std::uint32_t depth, std::uint32_t doubles = 2) {
    Agreement agreed = agreement();
    agreed.kind = kind;
    agreed.depth = depth;
    agreed.fields = {{"POSITION", Type::Double, doubles}};
    Bytes buffer(4096);
    const auto used = write_agreement(buffer, 1, agreed);
    return used.has_value() && read_agreement(Octets{buffer}.first(*used)).has_value();
  };
  EXPECT_TRUE(good(latest, 0));
  EXPECT_FALSE(good(latest, 64));
  EXPECT_FALSE(good(loaned, 64));
  EXPECT_FALSE(good(queued, 0));
  EXPECT_FALSE(good(queued, min_link_depth - 1));
  EXPECT_TRUE(good(queued, min_link_depth));
  EXPECT_TRUE(good(queued, max_link_depth));
  EXPECT_FALSE(good(queued, max_link_depth + 1));
  EXPECT_FALSE(good(queued, 65536 + 64)) << "nor as what is left of it in 16 bits";
  EXPECT_TRUE(good(queued, 1024, 8192));
  EXPECT_FALSE(good(queued, 1025, 8192));
}

TEST(LinkMessages, TooLongForTheirCountsAreNotWritten) {
  Bytes buffer(8192);
  Offer offer = full_offer();
  offer.set.assign(256, 'A');
  EXPECT_EQ(write_offer(buffer, 1, offer).error().code, ErrorCode::OutOfRange);
  offer = full_offer();
  offer.fields.assign(256, {"A", Type::Uint8, 1});
  EXPECT_EQ(write_offer(buffer, 1, offer).error().code, ErrorCode::OutOfRange);
  const auto used = write_refusal(buffer, 1, {4, std::string(300, 'x')});
  EXPECT_EQ(read_refusal(Octets{buffer}.first(used.value()))->refusal.text.size(), 255U) << "a long reason is cut";
}

TEST(LinkMessages, SurviveRandomOctets) {
  std::mt19937 random{3};
  for (int round = 0; round < 20000; ++round) {
    Bytes noise(random() % 80);
    for (auto& octet : noise) octet = static_cast<std::byte>(random() % 4 == 0 ? random() : random() % 6);
    std::ignore = read_offer(noise);
    std::ignore = read_agreement(noise);
    std::ignore = read_refusal(noise);
    std::ignore = read_offer_request(noise);
    std::ignore = read_terms_request(noise);
    std::ignore = read_attach_request(noise);
    std::ignore = read_attached(noise);
    std::ignore = read_reach_request(noise);
  }
}

}  // namespace
}  // namespace hirosco::pus::st128
