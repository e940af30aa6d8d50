// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <set>

#include "hirosco/parameter/type.hpp"
#include "hirosco/utilities/testing/slice.hpp"
#include "simulation/spacecraft/observed_flight.hpp"
#include "tests/integration/flight.hpp"
#include "tests/integration/mortal_channel.hpp"

/// What telecommands set of persistent parameters outlives process and flight (docs/adr/0087): rokviss, whose manipulator has one.
namespace hirosco::testing {
namespace {

constexpr std::uint16_t scaled_apid = 10;
constexpr std::uint16_t values_kept = 140, values_taken = 142, values_refused = 143;
const std::uint32_t scale_id = ParameterId{scaled_apid, Type::Double, 8}.wire();

void scale_is_persistent(descriptor::Mission& mission) {
  hand_rests(mission);
  for (auto& member : mission.subsystems)
    for (auto& parameter : member.subsystem.parameters)
      if (parameter.field.name == "POS_SCALE") parameter.persistent = true;
}

/// One flight of several; without a store it has no past and no future.
struct Scaled {
  explicit Scaled(supervisor::ValueStore* store = nullptr, int dies_at = 0)
      : flight{{.edit = scale_is_persistent,
                .wrap_channel = [this](std::string_view, std::unique_ptr<Channel> channel) -> std::unique_ptr<Channel> {
                  return std::make_unique<MortalChannel>(std::move(channel), deaths);
                },
                .values = store,
                .revives_after = 300ms}} {
    deaths.at = dies_at;
    deaths.dies = [this] { flight.craft().supervisor_dies_here(); };
    deaths.dying = [this] { return flight.craft().supervisor_is_dying(); };
    flight.story().on_telemetry = [this](const pus::TelemetryView& report) { hear(report); };
    commissioned = flight.commission();
  }
  Deaths deaths;
  Flight flight;
  bool commissioned{false};
  std::set<std::uint16_t> events;  ///< of the supervisor
  double told_scale{0};
  std::uint16_t count{0};

  void hear(const pus::TelemetryView& report) {
    OctetReader reader{report.source_data()};
    if (report.apid() == 1 && report.service() == 5) events.insert(reader.get<std::uint16_t>());
    if (report.apid() != scaled_apid || report.service() != 20 || report.subtype() != 2) return;
    static_cast<void>(reader.get<std::uint8_t>());
    if (reader.get<std::uint32_t>() == scale_id) told_scale = reader.get<double>();
  }

  /// A telecommand of service 20 with these data.
  [[nodiscard]] std::vector<std::byte> packet(std::uint8_t subtype, Octets data) {
    std::vector<std::byte> buffer(pus::max_telecommand_octets);
    const auto written = pus::write_telecommand(buffer,
                                                {.apid = scaled_apid,
                                                 .sequence_count = ++count,
                                                 .ack = pus::ack_all,
                                                 .service = 20,
                                                 .subtype = subtype,
                                                 .source = 7},
                                                data);
    return {written->begin(), written->end()};
  }
  [[nodiscard]] int send(std::uint8_t subtype, Octets data) { return flight.send(packet(subtype, data)).subtype; }
  [[nodiscard]] static std::array<std::byte, 13> scaled_by(double scale) {
    std::array<std::byte, 13> data;
    OctetWriter{data}.put(std::uint8_t{1}).put(scale_id).put(scale);
    return data;
  }
  [[nodiscard]] bool set(double scale) {
    if (!flight.set_state("MANIPULATOR", State::SafeOperational).completed) return false;
    const bool done = send(3, scaled_by(scale)) == 7;
    flight.craft().run(1s);
    return done;
  }
  /// As it tells itself.
  [[nodiscard]] double scale() {
    told_scale = 0;
    std::array<std::byte, 5> data;
    OctetWriter{data}.put(std::uint8_t{1}).put(scale_id);
    EXPECT_EQ(send(1, data), 7);
    flight.craft().run(100ms);
    return told_scale;
  }
};

struct PersistentFlight : ::testing::Test {
  supervisor::MemoryValueDisk disk;
  supervisor::DirectValueStore store{disk, "values"};
  supervisor::ValueCopies copies{disk, "values/MANIPULATOR"};
  void damage(std::size_t copy) {
    auto octets = disk.read(copies.path(copy), 4096).value();
    octets[octets.size() / 2] ^= std::byte{1};
    ASSERT_TRUE(disk.create(copies.path(copy), octets));
  }
  void set_in_a_flight(double scale) {
    Scaled flight{&store};
    ASSERT_TRUE(flight.commissioned) << flight.flight.story().text();
    ASSERT_TRUE(flight.set(scale));
    EXPECT_TRUE(flight.events.contains(values_kept));
  }
};

TEST_F(PersistentFlight, TheNextOneBeginsWithWhatThisOneWasTold) {
  set_in_a_flight(0.9);
  Scaled next{&store};
  ASSERT_TRUE(next.commissioned);
  EXPECT_EQ(next.scale(), 0.9);
  EXPECT_TRUE(next.flight.story().has("MANIPULATOR takes over 1 stored value, of "));
  EXPECT_TRUE(next.events.contains(values_taken));
}

TEST_F(PersistentFlight, OneDamagedCopyCostsNothingAndBothCostTheValue) {
  set_in_a_flight(0.9);
  for (const std::size_t copy : {0U, 1U}) {
    damage(copy);
    Scaled next{&store};
    EXPECT_EQ(next.scale(), 0.9);
    EXPECT_TRUE(next.events.contains(values_refused));
  }
  damage(0);
  damage(1);
  Scaled last{&store};
  EXPECT_EQ(last.scale(), 1.0);
  EXPECT_TRUE(last.flight.story().has("MANIPULATOR begins as its descriptor says"));
}

TEST_F(PersistentFlight, WhoDiesComesBackWithIt) {
  Scaled flight{&store};
  ASSERT_TRUE(flight.set(0.9));
  flight.flight.craft().kill("MANIPULATOR");
  flight.flight.craft().run(3s);
  ASSERT_TRUE(flight.flight.craft().alive("MANIPULATOR")) << flight.flight.story().text();
  ASSERT_TRUE(flight.flight.set_state("MANIPULATOR", State::PreOperational).completed) << flight.flight.story().text();
  EXPECT_EQ(flight.scale(), 0.9);
}

TEST_F(PersistentFlight, WhoGoesThroughOfflineComesBackWithIt) {
  Scaled flight{&store};
  ASSERT_TRUE(flight.set(0.9));
  for (const State state : {State::PreOperational, State::Offline, State::PreOperational})
    ASSERT_TRUE(flight.flight.set_state("MANIPULATOR", state).completed) << to_text(state);
  EXPECT_EQ(flight.scale(), 0.9);
}

[[nodiscard]] bool is_acceptance_of_the_scale(const Message& message) {
  const auto report = pus::TelemetryView::parse(message.packet);
  return report && report->apid() == scaled_apid && report->service() == 1 && report->subtype() == 1 &&
         report->destination() == 7;
}

/// kill -9 of the supervisor before and after each message that it takes or sends, from the acceptance on until the value is on the disk:
/// whatever its end, whoever hears it (docs/adr/0168).
TEST_F(PersistentFlight, AValueThatWasAcceptedIsKeptWheneverTheSupervisorDies) {
  int flights = 0;
  for (int at = 1;; at += one_in(2)) {
    supervisor::MemoryValueDisk own_disk;
    supervisor::DirectValueStore own_store{own_disk, "values"};
    Scaled flight{&own_store, at};
    ASSERT_TRUE(flight.commissioned) << flight.flight.story().text();
    ASSERT_TRUE(flight.flight.set_state("MANIPULATOR", State::SafeOperational).completed);
    flight.deaths.begins = [&](const Message& message) {
      return flight.deaths.passed == 0 && is_acceptance_of_the_scale(message);
    };
    const auto hear = flight.flight.story().on_telemetry;
    flight.flight.story().on_telemetry = [&](const pus::TelemetryView& report) {
      hear(report);
      if (flight.events.contains(values_kept)) flight.deaths.armed = false;
    };
    flight.flight.craft().ground().send(flight.packet(3, Scaled::scaled_by(0.9)));
    flight.flight.craft().run(5s);
    ++flights;
    const auto copies = supervisor::ValueCopies{own_disk, "values/MANIPULATOR"}.read();
    const std::string text = "dies at " + std::to_string(at) + "\n" + flight.flight.story().text();
    for (const auto& copy : copies) {
      ASSERT_TRUE(copy) << text;
      EXPECT_TRUE(std::ranges::equal(copy->values, Scaled::scaled_by(0.9))) << text;
    }
    EXPECT_TRUE(flight.events.contains(values_kept) || flight.events.contains(values_taken)) << text;
    if (HasFailure() || flight.flight.craft().supervisor_deaths() == 0) break;
  }
  EXPECT_GT(flights, 4 / one_in(2));
  std::printf("%d flights\n", flights);
}

TEST(PersistentFlights, WithoutAFolderNoneKnowsOfAnother) {
  {
    Scaled flight;
    ASSERT_TRUE(flight.set(0.9));
  }
  Scaled next;
  EXPECT_EQ(next.scale(), 1.0);
  EXPECT_FALSE(next.flight.story().has("takes over"));
}

}  // namespace
}  // namespace hirosco::testing
