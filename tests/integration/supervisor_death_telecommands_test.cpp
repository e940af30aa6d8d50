// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <vector>

#include "tests/integration/late_log.hpp"
#include "tests/integration/mortal_flight.hpp"

/// The supervisor dies while telecommands wait for a disk that takes its time, leave, and are answered (docs/adr/0190).
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

}  // namespace
}  // namespace hirosco::testing
