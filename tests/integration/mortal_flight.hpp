// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "hirosco/utilities/testing/slice.hpp"
#include "simulation/spacecraft/observed_flight.hpp"
#include "tests/integration/flight.hpp"
#include "tests/integration/mortal_channel.hpp"

/// A flight whose supervisor dies, before or after each single message that it sends or takes, and another one goes on (docs/adr/0093).
namespace hirosco::testing {

/// How each telecommand of the ground ended, by its request id. Those of the supervisor itself are its own concern.
struct Verdicts {
  struct Verdict {
    int accepted{0};
    int final{0};
    int unknown{0};  ///< of these, "outcome unknown"
    int refused{0};  ///< of these, by the supervisor: its addressee was not to have it
  };
  std::map<std::uint32_t, Verdict> of;
  void hear(const pus::TelemetryView& report) {
    if (report.service() != 1 || report.destination() != 0) return;
    OctetReader reader{report.source_data()};
    Verdict& verdict = of[reader.get<std::uint32_t>()];
    if (report.subtype() == 1) ++verdict.accepted;
    if (report.subtype() == 2 && report.apid() == pus::supervisor_apid) ++verdict.refused;
    if (report.subtype() == 2 || report.subtype() == 4 || report.subtype() == 7 || report.subtype() == 8 ||
        report.subtype() == 10)
      ++verdict.final;
    if (report.subtype() == 8 &&
        reader.get<std::uint16_t>() == static_cast<std::uint16_t>(pus::FailureCode::OutcomeUnknown))
      ++verdict.unknown;
  }
};

struct MortalFlight {
  explicit MortalFlight(int dies_at, Plan plan = {.edit = simulation::hand_rests}) : flight{mortal(std::move(plan))} {
    deaths.at = dies_at;
    deaths.dies = [this] { flight.craft().supervisor_dies_here(); };
    deaths.dying = [this] { return flight.craft().supervisor_is_dying(); };
  }
  [[nodiscard]] bool may_move(const char* name) {
    const auto* page = flight.craft().permit(name);
    return page != nullptr && page->permits(page->epoch.load());
  }
  /// A telecommand without arguments, or with one of one octet.
  void send(std::uint16_t count, std::string_view function, std::optional<std::uint8_t> argument = {}) {
    auto asked = call_data(function, {});
    if (argument) {
      asked.back() = std::byte{1};
      asked.insert(asked.end(), {std::byte{1}, std::byte{*argument}});
    }
    flight.craft().ground().send(function_packet(1, count, asked));
  }
  [[nodiscard]] std::string text() { return "dies at " + std::to_string(deaths.at) + "\n" + flight.story().text(); }

  Deaths deaths;
  Verdicts verdicts;
  Flight flight;

 private:
  [[nodiscard]] Plan mortal(Plan plan) {
    plan.wrap_channel = [this](std::string_view, std::unique_ptr<Channel> channel) -> std::unique_ptr<Channel> {
      return std::make_unique<MortalChannel>(std::move(channel), deaths);
    };
    plan.revives_after = 300ms;
    return plan;
  }
};

/// From a death until all has come to rest or goes on: 300 ms until another one is there, then the longest way down.
inline constexpr Duration settles = 1500ms;

[[nodiscard]] inline Plan hand_at_rest() { return {.edit = simulation::hand_rests}; }

/// Flies `plan` again and again, with a death one moment later each time of those in the `span` that `begin` begins, until none comes any
/// more; the number of flights.
inline int at_every_moment(const std::function<void(MortalFlight&)>& begin,
                           const std::function<void(MortalFlight&)>& judge, int every = one_in(3),
                           const std::function<Plan()>& plan = hand_at_rest, Duration span = 1s) {
  int flights = 0;
  for (int at = 1;; at += every) {
    MortalFlight mortal{at, plan()};
    Flight& flight = mortal.flight;
    flight.story().on_telemetry = [&](const pus::TelemetryView& report) { mortal.verdicts.hear(report); };
    if (!flight.commission()) {
      ADD_FAILURE() << "not commissioned\n" << mortal.text();
      return flights;
    }
    flight.craft().run(100ms);
    mortal.deaths.armed = true;
    begin(mortal);
    flight.craft().run(span);
    mortal.deaths.armed = false;
    const bool died = flight.craft().supervisor_deaths() > 0;
    flight.craft().run(settles);
    ++flights;
    judge(mortal);
    if (::testing::Test::HasFailure()) return flights;
    if (!died) return flights;
  }
}

}  // namespace hirosco::testing
