// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <functional>
#include <memory>
#include <vector>

#include "tests/integration/late_log.hpp"
#include "tests/integration/mortal_flight.hpp"

/// The supervisor dies while telecommands wait for a disk that takes its time, leave, and are answered (docs/adr/0190), and while it is
/// set itself (docs/adr/0205).
namespace hirosco::testing {
namespace {

/// Longer than a step: what waits leaves in a later one.
constexpr Duration disk_takes = 25ms;
/// From the first word of the next supervisor: what is told of those that nobody tells of.
constexpr Duration doubt_is_over = 2s;

/// In a mode in which each moves by telecommand.
[[nodiscard]] Plan on_a_real_disk() {
  return {.edit =
              [](descriptor::Mission& mission) {
                simulation::hand_rests(mission);
                mission.start_mode = "standalone";
              },
          .make_log = [](const Clock& clock) -> std::unique_ptr<supervisor::PacketLog> {
            return std::make_unique<LateLog>(clock, disk_takes);
          }};
}

/// One that ends at once, one that takes its time, and one of somebody else, in one batch.
void command_both(MortalFlight& mortal) {
  const auto send = [&](const char* name, std::uint16_t count, const std::vector<std::byte>& call) {
    const std::uint16_t apid = mortal.flight.mission().find_subsystem(name)->subsystem.id;
    mortal.flight.craft().ground().send(function_packet(apid, count, call));
  };
  send("MANIPULATOR", 4000, call_data("HOLD", {}));
  send("MANIPULATOR", 4001, call_data("MOVE_TO", {0.1, 1.3, 0.8}));
  send("JOYSTICK", 4002, call_data("CENTRE", {}));
}

TEST(SupervisorDeath, AtEveryMomentOfTelecommandsThatWaitForADiskNoneIsRefusedThatIsCarriedOut) {
  int refused = 0, unknown = 0, carried_out = 0;
  const int flights = at_every_moment(
      command_both,
      [&](MortalFlight& mortal) {
        mortal.flight.craft().run(doubt_is_over);
        for (const auto& [id, verdict] : mortal.verdicts.of) {
          EXPECT_FALSE(verdict.refused > 0 && verdict.accepted > 0) << std::hex << id << "\n" << mortal.text();
          EXPECT_LE(verdict.final - verdict.unknown, 1) << std::hex << id << "\n" << mortal.text();
          EXPECT_TRUE(verdict.accepted == 0 || verdict.final > 0) << std::hex << id << "\n" << mortal.text();
          refused += verdict.refused;
          unknown += verdict.unknown;
          carried_out += verdict.accepted > 0 && verdict.unknown == 0 ? 1 : 0;
        }
      },
      1, on_a_real_disk, 4 * disk_takes);
  EXPECT_GT(flights, 12);
  EXPECT_GT(refused, 0) << "what still waited";
  EXPECT_GT(unknown, 0) << "what was about to leave and did not";
  EXPECT_GT(carried_out, 0);
  std::printf("%d flights, refused: %d, unknown: %d, carried out: %d\n", flights, refused, unknown, carried_out);
}

/// TC[3,subtype] to the supervisor itself.
[[nodiscard]] std::vector<std::byte> own_housekeeping(std::uint16_t count, std::uint8_t subtype,
                                                      const std::function<void(OctetWriter&)>& put) {
  std::vector<std::byte> data(64), buffer(pus::max_telecommand_octets);
  OctetWriter writer{data};
  put(writer);
  const auto packet = pus::write_telecommand(buffer,
                                             {.apid = pus::supervisor_apid,
                                              .sequence_count = count,
                                              .ack = pus::ack_all,
                                              .service = 3,
                                              .subtype = subtype,
                                              .source = 0},
                                             writer.written());
  return {packet->begin(), packet->end()};
}

/// docs/adr/0205
TEST(SupervisorDeath, AtEveryMomentOfAnIntervalThatGroundSetsOfTheSupervisorItIsSetWhereThatWasTold) {
  constexpr std::uint8_t single = 1;
  constexpr std::uint16_t rows = 4702;
  constexpr std::uint32_t by_its_descriptor = 20, by_ground = 50;
  int set = 0;
  const int flights = at_every_moment(
      [](MortalFlight& mortal) {
        mortal.flight.craft().ground().send(
            own_housekeeping(4000, 31, [](OctetWriter& data) { data.put(single).put(rows).put(by_ground); }));
      },
      [&](MortalFlight& mortal) {
        Flight& flight = mortal.flight;
        const auto verdicts = mortal.verdicts.of;
        std::uint32_t interval = 0;
        flight.story().on_telemetry = [&interval](const pus::TelemetryView& report) {
          if (report.apid() != pus::supervisor_apid || report.service() != 3 || report.subtype() != 35) return;
          OctetReader reader{report.source_data()};
          static_cast<void>(reader.get(1 + 2 + 1));
          interval = reader.get<std::uint32_t>();
        };
        const auto asked = own_housekeeping(4001, 33, [](OctetWriter& data) { data.put(single).put(rows); });
        EXPECT_EQ(flight.send(asked).subtype, 7) << mortal.text();
        flight.story().on_telemetry = nullptr;
        EXPECT_TRUE(interval == by_its_descriptor || interval == by_ground) << interval << "\n" << mortal.text();
        for (const auto& [id, verdict] : verdicts) {
          const bool completed = verdict.final > verdict.unknown + verdict.refused;
          if (completed || verdict.refused > 0) {
            EXPECT_EQ(interval, completed ? by_ground : by_its_descriptor) << mortal.text();
          }
          set += completed && flight.craft().supervisor_deaths() > 0 ? 1 : 0;
        }
      },
      1, hand_at_rest, 20ms);
  EXPECT_GT(flights, 5);
  EXPECT_GT(set, 0) << "told, and then it died";
  std::printf("%d flights, set before the death: %d\n", flights, set);
}

}  // namespace
}  // namespace hirosco::testing
