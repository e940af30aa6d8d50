// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <set>

#include "hirosco/parameter/type.hpp"
#include "simulation/spacecraft/observed_flight.hpp"
#include "tests/integration/flight.hpp"

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
  explicit Scaled(supervisor::ValueStore* store = nullptr) : flight{{.edit = scale_is_persistent, .values = store}} {
    flight.story().on_telemetry = [this](const pus::TelemetryView& report) { hear(report); };
    commissioned = flight.commission();
  }
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

  [[nodiscard]] int send(std::uint8_t subtype, Octets data) {
    std::vector<std::byte> buffer(pus::max_telecommand_octets);
    const auto packet = pus::write_telecommand(buffer,
                                               {.apid = scaled_apid,
                                                .sequence_count = ++count,
                                                .ack = pus::ack_all,
                                                .service = 20,
                                                .subtype = subtype,
                                                .source = 7},
                                               data);
    return flight.send(*packet).subtype;
  }
  [[nodiscard]] bool set(double scale) {
    if (!flight.set_state("MANIPULATOR", State::SafeOperational).completed) return false;
    std::array<std::byte, 13> data;
    OctetWriter{data}.put(std::uint8_t{1}).put(scale_id).put(scale);
    const bool done = send(3, data) == 7;
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
