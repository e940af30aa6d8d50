// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/communication/ground_clients.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <random>

namespace hirosco::communication {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::byte> ping_of(std::size_t data_octets = 0, std::uint16_t count = 0) {
  std::vector<std::byte> buffer(pus::max_telecommand_octets);
  const std::vector<std::byte> data(data_octets, std::byte{0x5A});
  const auto packet =
      pus::write_telecommand(buffer, {.apid = 11, .sequence_count = count, .service = 17, .subtype = 1}, data);
  return {packet->begin(), packet->end()};
}

/// A header with this length field and nothing behind it.
std::vector<std::byte> header(std::uint16_t first_two, std::uint16_t length) {
  std::vector<std::byte> octets(6);
  OctetWriter{octets}.put(first_two).put(std::uint16_t{0xC000}).put(length);
  return octets;
}

void append(std::vector<std::byte>& stream, const std::vector<std::byte>& more) {
  stream.insert(stream.end(), more.begin(), more.end());
}

using Packets = std::vector<std::vector<std::byte>>;
struct Sink {
  Packets packets;
  void operator()(Octets packet) { packets.emplace_back(packet.begin(), packet.end()); }
};

/// All octets of a stream, whole packets taken as soon as they are there.
template <class Take>
std::optional<CloseReason> feed(Deframer& deframer, Octets octets, TimePoint now, Take&& take) {
  while (!octets.empty() && !deframer.spoilt()) {
    const MutableOctets room = deframer.room();
    const std::size_t count = std::min(room.size(), octets.size());
    std::ranges::copy(octets.first(count), room.begin());
    deframer.put(count, now);
    octets = octets.subspan(count);
    for (; !deframer.front().empty(); deframer.pop(now)) take(deframer.front());
  }
  return deframer.spoilt();
}
template <class Take>
std::optional<CloseReason> feed(Deframer&& deframer, Octets octets, TimePoint now, Take&& take) {
  return feed(deframer, octets, now, take);
}

TEST(Deframer, CutsPacketsWhereverTheStreamIsDivided) {
  const Packets sent{ping_of(), ping_of(100, 1), ping_of(pus::max_telecommand_octets - 13, 2), ping_of(1, 3)};
  std::vector<std::byte> stream;
  for (const auto& packet : sent) append(stream, packet);
  for (const std::size_t piece : {std::size_t{1}, std::size_t{2}, std::size_t{5}, std::size_t{6}, std::size_t{7},
                                  std::size_t{13}, std::size_t{1000}, stream.size()}) {
    Deframer deframer;
    Sink sink;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
      const Octets octets = Octets{stream}.subspan(at, std::min(piece, stream.size() - at));
      ASSERT_FALSE(feed(deframer, octets, {}, sink));
    }
    EXPECT_EQ(sink.packets, sent) << piece;
    EXPECT_FALSE(deframer.deadline());
  }
}

TEST(Deframer, TakesExactlyThePlausibleLengths) {
  for (std::size_t field = 0; field <= 0xFFFF; ++field) {
    Deframer deframer;
    Sink sink;
    const auto reason = feed(deframer, header(0x180B, static_cast<std::uint16_t>(field)), {}, sink);
    const bool plausible = field + 7 >= 13 && field + 7 <= 4096;
    ASSERT_EQ(reason, plausible ? std::nullopt : std::optional{CloseReason::Length}) << field;
    ASSERT_THAT(sink.packets, IsEmpty());
  }
}

TEST(Deframer, EndsTheStreamAtAVersionOrTypeThatIsNoTelecommand) {
  Sink sink;
  EXPECT_EQ(feed(Deframer{}, header(0x080B, 6), {}, sink), CloseReason::NotTelecommand);
  for (unsigned version = 1; version <= 7; ++version)
    EXPECT_EQ(feed(Deframer{}, header(static_cast<std::uint16_t>(0x180BU | version << 13), 6), {}, sink),
              CloseReason::Version);
}

TEST(Deframer, HandsOnWhateverIsDamagedBehindAPlausibleHeader) {
  const auto good = ping_of(20);
  for (std::size_t bit = 0; bit < good.size() * 8; ++bit) {
    auto damaged = good;
    damaged[bit / 8] ^= static_cast<std::byte>(0x80 >> bit % 8);
    Deframer deframer;
    Sink sink;
    const auto reason = feed(deframer, damaged, {}, sink);
    const std::size_t announced = pus::announced_octets(damaged);
    if (bit < 3) EXPECT_EQ(reason, CloseReason::Version);
    else if (bit == 3) EXPECT_EQ(reason, CloseReason::NotTelecommand);
    else if (announced > 4096 || announced < 13) EXPECT_EQ(reason, CloseReason::Length) << bit;
    else if (announced <= damaged.size()) EXPECT_EQ(sink.packets.at(0).size(), announced) << bit;
    else EXPECT_TRUE(sink.packets.empty() && deframer.deadline()) << bit;
  }
}

TEST(Deframer, NeverFindsATelecommandInsideASpoiltStream) {
  auto stream = header(0x180B, 0xFFFF);
  for (int i = 0; i < 1000; ++i) append(stream, ping_of());
  Deframer deframer;
  Sink sink;
  EXPECT_TRUE(feed(deframer, stream, {}, sink));
  EXPECT_EQ(feed(deframer, ping_of(), {}, sink), CloseReason::Length);
  EXPECT_THAT(sink.packets, IsEmpty());
}

TEST(Deframer, GivesAPacketTwoSecondsFromItsFirstOctet) {
  const auto packet = ping_of(10);
  Deframer deframer;
  Sink sink;
  const TimePoint begun{5s};
  ASSERT_FALSE(feed(deframer, Octets{packet}.first(1), begun, sink));
  EXPECT_EQ(deframer.deadline(), begun + 2s);
  // A trickle of octets does not prolong it.
  ASSERT_FALSE(feed(deframer, Octets{packet}.subspan(1, 1), begun + 1999ms, sink));
  deframer.check(begun + 1999ms);
  EXPECT_FALSE(deframer.spoilt());
  deframer.check(begun + 2s);
  EXPECT_EQ(deframer.spoilt(), CloseReason::Incomplete);
  EXPECT_TRUE(feed(deframer, Octets{packet}.subspan(2), begun + 2s, sink));
  EXPECT_THAT(sink.packets, IsEmpty());
}

TEST(Deframer, WaitsForEverBetweenPackets) {
  Deframer deframer;
  Sink sink;
  ASSERT_FALSE(feed(deframer, ping_of(), {}, sink));
  deframer.check(TimePoint{1000h});
  EXPECT_FALSE(deframer.spoilt());
}

TEST(Deframer, DropsIdlePacketsSilently) {
  auto stream = header(0x17FF, 0);
  stream.push_back(std::byte{0x55});
  append(stream, ping_of());
  Deframer deframer;
  Sink sink;
  EXPECT_FALSE(feed(deframer, stream, {}, sink));
  EXPECT_EQ(sink.packets.size(), 1U);
  EXPECT_EQ(deframer.idle_packets(), 1U);
}

TEST(Deframer, KeepsWholePacketsUntilTheyAreTakenAndHasNoRoomWhileItIsFullOfThem) {
  const auto packet = ping_of();
  std::vector<std::byte> stream;
  while (stream.size() < 2 * Deframer::capacity) append(stream, packet);
  Deframer deframer;
  std::size_t put = 0;
  for (MutableOctets room = deframer.room(); !room.empty(); room = deframer.room()) {
    std::ranges::copy(Octets{stream}.subspan(put, room.size()), room.begin());
    put += room.size();
    deframer.put(room.size(), {});
  }
  EXPECT_EQ(put, Deframer::capacity);
  // Who is not read because others are behind has not left a packet incomplete.
  deframer.check(TimePoint{1000h});
  std::size_t whole = 0;
  for (; !deframer.front().empty(); deframer.pop(TimePoint{1000h})) ++whole;
  EXPECT_EQ(whole, put / packet.size());
  EXPECT_EQ(deframer.deadline(), TimePoint{1000h} + 2s);
}

TEST(Deframer, SaysOfAPacketThatTheEndOfTheStreamCutsOffThatItIsIncomplete) {
  const auto packet = ping_of(3);
  for (std::size_t cut = 0; cut <= packet.size(); ++cut) {
    auto stream = ping_of();
    stream.insert(stream.end(), packet.begin(), packet.begin() + static_cast<std::ptrdiff_t>(cut));
    Deframer deframer;
    std::ranges::copy(stream, deframer.room().begin());
    deframer.put(stream.size(), {});
    deframer.end();
    ASSERT_FALSE(deframer.spoilt()) << "a whole packet comes first";
    deframer.pop({});
    if (cut == packet.size()) deframer.pop({});
    const bool whole = cut == 0 || cut == packet.size();
    EXPECT_EQ(deframer.spoilt(), whole ? std::nullopt : std::optional{CloseReason::Incomplete}) << cut;
  }
}

struct Received final : GroundTraffic {
  Taken telecommand(ClientId client, Octets packet, Said) override {
    if (room == 0) return Taken::Later;
    --room;
    all.emplace_back(client, packet.size());
    return Taken::Yes;
  }
  std::vector<std::pair<ClientId, std::size_t>> all;
  std::size_t room{1'000'000};
};

/// Puts as much as goes; how much that was.
std::size_t put(GroundClients& clients, ClientId client, Octets octets, TimePoint now = {}) {
  const MutableOctets room = clients.room(client);
  const std::size_t count = std::min(room.size(), octets.size());
  std::ranges::copy(octets.first(count), room.begin());
  clients.received(client, count, now);
  return count;
}

void receive(GroundClients& clients, ClientId client, Octets octets, TimePoint now, GroundTraffic& traffic) {
  EXPECT_EQ(put(clients, client, octets, now), octets.size());
  EXPECT_TRUE(clients.hand_over(traffic, now));
}

ClientId admit(GroundClients& clients, GroundPort port = GroundPort::TelemetryAndTelecommands) {
  const auto admission = clients.admit(port, {});
  return admission ? admission->client : ClientId{0};
}

std::vector<std::byte> drain(GroundClients& clients, ClientId client, std::size_t at_once = 1'000'000) {
  std::vector<std::byte> all;
  for (Octets output = clients.output(client); !output.empty(); output = clients.output(client)) {
    output = output.first(std::min(output.size(), at_once));
    all.insert(all.end(), output.begin(), output.end());
    clients.sent(client, output.size());
  }
  return all;
}

TEST(GroundClients, GiveAllTelemetryToTelemetryClientsOnly) {
  GroundClients clients{{}};
  const ClientId first = admit(clients);
  const ClientId commander = admit(clients, GroundPort::TelecommandsOnly);
  ASSERT_TRUE(clients.telemetry(ping_of(5)));
  const ClientId late = admit(clients);
  ASSERT_TRUE(clients.telemetry(ping_of(6)));
  auto both = ping_of(5);
  append(both, ping_of(6));
  EXPECT_EQ(drain(clients, first), both);
  EXPECT_EQ(drain(clients, late), ping_of(6));
  EXPECT_THAT(drain(clients, commander), IsEmpty());
}

TEST(GroundClients, CutWhoDoesNotReadAndServeTheOthersWholly) {
  GroundClients clients{{.backlog_octets = 10'000}};
  const ClientId slow = admit(clients);
  const ClientId quick = admit(clients);
  std::vector<std::byte> expected;
  std::vector<std::byte> got;
  for (std::uint16_t i = 0; i < 200; ++i) {
    const auto packet = ping_of(i % 300U, i);
    append(expected, packet);
    ASSERT_TRUE(clients.telemetry(packet));
    append(got, drain(clients, quick, 77));
  }
  EXPECT_EQ(got, expected);
  EXPECT_EQ(clients.condemned(slow), CloseReason::Slow);
  EXPECT_THAT(clients.output(slow), IsEmpty());
  EXPECT_FALSE(clients.condemned(quick));
  clients.remove(slow, CloseReason::PeerClosed);
  EXPECT_EQ(clients.counters().closed[static_cast<std::size_t>(CloseReason::Slow)], 1U);
}

TEST(GroundClients, EvictTheOldestSilentClientNeverOneThatHasSpoken) {
  GroundClients clients{{.clients = 3}};
  Received traffic;
  const ClientId honest = admit(clients);
  receive(clients, honest, ping_of(), {}, traffic);
  const ClientId noisy = admit(clients);
  auto damaged = ping_of();
  damaged.back() ^= std::byte{1};
  receive(clients, noisy, damaged, {}, traffic);
  const ClientId silent = admit(clients);
  EXPECT_EQ(clients.admit(GroundPort::TelecommandsOnly, {})->evicted, noisy);
  EXPECT_EQ(clients.admit(GroundPort::TelecommandsOnly, {})->evicted, silent);
  EXPECT_NE(clients.counters_of(honest), nullptr);
  EXPECT_EQ(clients.counters_of(silent), nullptr);
}

TEST(GroundClients, RefuseANewcomerWhenEveryPlaceHasSpoken) {
  GroundClients clients{{.clients = 2}};
  Received traffic;
  for (int i = 0; i < 2; ++i) receive(clients, admit(clients), ping_of(), {}, traffic);
  EXPECT_EQ(admit(clients), 0);
  EXPECT_EQ(clients.counters().refused, 1U);
}

TEST(GroundClients, KeepWhatNobodyTakesAndReadNoMoreOfWhoSentIt) {
  GroundClients clients{{}};
  Received traffic;
  traffic.room = 0;
  const ClientId client = admit(clients);
  std::vector<std::byte> stream;
  for (std::uint16_t i = 0; i < 3000; ++i) append(stream, ping_of(0, i));
  Octets rest{stream};
  constexpr std::size_t most_rounds = 10'000;  // a lost packet never comes
  for (std::size_t round = 0; round < most_rounds && (!rest.empty() || traffic.all.size() < 3000); ++round) {
    rest = rest.subspan(put(clients, client, rest));
    traffic.room = round % 3 == 0 ? 7 : 0;
    clients.hand_over(traffic, {});
  }
  EXPECT_EQ(traffic.all.size(), 3000U);
  EXPECT_EQ(clients.counters().packets, 3000U);
  EXPECT_GT(clients.counters().held_back, 0U);
}

TEST(GroundClients, TakeOnePacketOfEachInTurn) {
  GroundClients clients{{}};
  Received traffic;
  const ClientId flood = admit(clients);
  const ClientId second = admit(clients, GroundPort::TelecommandsOnly);
  const ClientId honest = admit(clients);
  std::vector<std::byte> many;
  for (std::uint16_t i = 0; i < 300; ++i) append(many, ping_of(0, i));
  put(clients, flood, many);
  put(clients, second, many);
  // Somewhere in the middle of the flood, where nobody takes anything for a while.
  traffic.room = 101;
  EXPECT_FALSE(clients.hand_over(traffic, {}));
  put(clients, honest, ping_of(1));
  traffic.room = 3;
  EXPECT_FALSE(clients.hand_over(traffic, {}));
  EXPECT_EQ(traffic.all.back().first, honest);
}

TEST(GroundClients, LetAFloodWaitForAListenerThatCatchesUpAndNobodyElse) {
  GroundClients clients{{.behind_octets = 1000, .patience = 1s}};
  Received traffic;
  const ClientId listener = admit(clients);
  const ClientId flood = admit(clients, GroundPort::TelecommandsOnly);
  const ClientId honest = admit(clients, GroundPort::TelecommandsOnly);
  std::vector<std::byte> many;
  for (std::uint16_t i = 0; i < 100; ++i) append(many, ping_of(0, i));
  TimePoint now{10s};
  receive(clients, flood, many, now, traffic);
  while (clients.output(listener).size() <= 1000) ASSERT_TRUE(clients.telemetry(ping_of(100)));

  traffic.all.clear();
  put(clients, flood, many, now);
  put(clients, honest, ping_of(), now);
  EXPECT_FALSE(clients.hand_over(traffic, now));
  EXPECT_THAT(traffic.all, ElementsAre(std::pair{honest, 13U}));

  // Having read half of it is enough.
  clients.sent(listener, clients.output(listener).size() - 500);
  EXPECT_TRUE(clients.hand_over(traffic, now));
  EXPECT_EQ(traffic.all.size(), 101U);
}

/// A stop may come from who has sent much: it waits for one period, not for all that it sent before anybody was behind.
TEST(GroundClients, HoldNothingAgainstAClientThatItSentWhileNobodyWasBehind) {
  GroundClients clients{{.behind_octets = 1000, .patience = 1s}};
  Received traffic;
  const ClientId listener = admit(clients);
  const ClientId busy = admit(clients, GroundPort::TelecommandsOnly);
  std::vector<std::byte> many;
  for (std::uint16_t i = 0; i < 1000; ++i) append(many, ping_of(0, i));
  const TimePoint now{10s};
  for (Octets rest{many}; !rest.empty() || clients.waiting_packets() > 0; clients.hand_over(traffic, now))
    rest = rest.subspan(put(clients, busy, rest, now));
  ASSERT_EQ(traffic.all.size(), 1000U);
  while (clients.output(listener).size() <= 1000) ASSERT_TRUE(clients.telemetry(ping_of(100)));

  traffic.all.clear();
  put(clients, busy, ping_of(), now);
  EXPECT_FALSE(clients.hand_over(traffic, now));
  EXPECT_FALSE(clients.hand_over(traffic, now + 49ms));
  EXPECT_TRUE(traffic.all.empty()) << "it sends no more than who sends little";
  EXPECT_TRUE(clients.hand_over(traffic, now + 50ms));
  EXPECT_EQ(traffic.all.size(), 1U);
}

TEST(GroundClients, WaitNoLongerThanTheirPatienceForAListenerThatDoesNotCatchUp) {
  GroundClients clients{{.behind_octets = 1000, .patience = 1s}};
  Received traffic;
  static_cast<void>(admit(clients));
  const ClientId flood = admit(clients, GroundPort::TelecommandsOnly);
  std::vector<std::byte> many;
  for (std::uint16_t i = 0; i < 100; ++i) append(many, ping_of(0, i));
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(clients.telemetry(ping_of(100)));
  const TimePoint now{10s};
  put(clients, flood, many, now);
  clients.hand_over(traffic, now);
  const std::size_t at_first = traffic.all.size();
  EXPECT_LT(at_first, 100U);
  clients.hand_over(traffic, now + 400ms);
  EXPECT_LT(traffic.all.size(), 100U);
  EXPECT_TRUE(clients.hand_over(traffic, now + 1s));
  EXPECT_EQ(traffic.all.size(), 100U);
}

TEST(GroundClients, LetGoOfWhoLeavesOnlyWhenAllThatItSentIsTaken) {
  GroundClients clients{{}};
  Received traffic;
  traffic.room = 0;
  const ClientId client = admit(clients, GroundPort::TelecommandsOnly);
  auto stream = ping_of();
  append(stream, ping_of(0, 1));
  append(stream, {std::byte{0x18}});
  put(clients, client, stream);
  clients.dismiss(client, CloseReason::PeerClosed);
  clients.hand_over(traffic, {});
  EXPECT_FALSE(clients.condemned(client));
  traffic.room = 2;
  clients.hand_over(traffic, {});
  EXPECT_EQ(traffic.all.size(), 2U);
  // The third was cut off by its sender.
  EXPECT_EQ(clients.condemned(client), CloseReason::Incomplete);
}

TEST(GroundClients, LetNobodyGiveWayWhosePacketsWait) {
  GroundClients clients{{.clients = 8, .reserve = 1}};
  Received traffic;
  traffic.room = 0;
  std::vector<ClientId> all;
  for (int i = 0; i < 8; ++i) {
    all.push_back(admit(clients, GroundPort::TelecommandsOnly));
    put(clients, all.back(), ping_of());
  }
  EXPECT_FALSE(clients.admissible(GroundPort::TelecommandsOnly));
  EXPECT_FALSE(clients.admissible(GroundPort::TelemetryAndTelecommands));
  traffic.room = 1;
  clients.hand_over(traffic, {});
  EXPECT_TRUE(clients.admissible(GroundPort::TelecommandsOnly));
  EXPECT_EQ(clients.admit(GroundPort::TelecommandsOnly, {})->evicted, all.front());
}

TEST(GroundClients, LetANewcomerOfTheTelecommandPortInWhateverElseIsTaken) {
  GroundClients clients{{.clients = 16, .reserve = 2}};
  Received traffic;
  TimePoint now{1s};
  const auto speak = [&](GroundPort port) {
    now += 1ms;
    const auto admission = clients.admit(port, now);
    if (!admission) return false;
    receive(clients, admission->client, ping_of(), now, traffic);
    return true;
  };
  // A flood on the telemetry port, each of which has sent a valid packet, takes all but the reserve.
  int in = 0;
  for (int i = 0; i < 100; ++i) in += speak(GroundPort::TelemetryAndTelecommands) ? 1 : 0;
  EXPECT_EQ(in, 14);
  // On the telecommand port there is always a way in: who was quiet for longest gives way.
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(speak(GroundPort::TelecommandsOnly)) << i;
  EXPECT_EQ(clients.counters().closed[static_cast<std::size_t>(CloseReason::Evicted)], 98U);
  EXPECT_EQ(traffic.all.size(), 114U);
}

TEST(GroundClients, NumberAPlaceAnewForEachClient) {
  GroundClients clients{{.clients = 1}};
  const ClientId first = admit(clients);
  clients.remove(first, CloseReason::PeerClosed);
  const ClientId second = admit(clients);
  EXPECT_NE(first, second);
  Received traffic;
  EXPECT_EQ(put(clients, first, ping_of()), 0U);
  clients.hand_over(traffic, {});
  EXPECT_THAT(traffic.all, IsEmpty());
  for (int i = 0; i < 1000; ++i) {
    const ClientId next = admit(clients);
    ASSERT_NE(next, 0);
    ASSERT_EQ(GroundClients::place_of(next), 0U);
  }
}

TEST(GroundClients, CountByClientAndByReason) {
  GroundClients clients{{}};
  Received traffic;
  const ClientId good = admit(clients);
  auto two = ping_of();
  append(two, ping_of(3));
  two.back() ^= std::byte{1};
  receive(clients, good, two, {}, traffic);
  EXPECT_THAT(traffic.all, ElementsAre(std::pair{good, 13U}, std::pair{good, 16U}));
  EXPECT_EQ(clients.counters_of(good)->packets, 2U);
  EXPECT_EQ(clients.counters_of(good)->valid_packets, 1U);

  const ClientId late = admit(clients);
  receive(clients, late, Octets{two}.first(3), TimePoint{1s}, traffic);
  EXPECT_EQ(clients.step(TimePoint{2s}), TimePoint{3s});
  clients.step(TimePoint{3s});
  EXPECT_EQ(clients.condemned(late), CloseReason::Incomplete);
  clients.remove(late, CloseReason::PeerClosed);
  EXPECT_EQ(clients.counters().closed[static_cast<std::size_t>(CloseReason::Incomplete)], 1U);
  EXPECT_EQ(clients.counters().clients, 1U);
}

}  // namespace
}  // namespace hirosco::communication
