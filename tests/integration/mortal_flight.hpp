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
#include <vector>

#include "hirosco/utilities/testing/slice.hpp"
#include "simulation/spacecraft/observed_flight.hpp"
#include "supervisor/keeper/kept.hpp"
#include "tests/integration/flight.hpp"
#include "tests/integration/mortal_channel.hpp"

/// A flight whose supervisor is lost, before or after each single message that it sends or takes, and another one goes on (docs/adr/0093).
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

/// How: by kill -9, or as one that stands still in the midst of its step, beside its guard, until its keeper ends it (docs/adr/0233).
enum class Loss : std::uint8_t { Death, Hang };

struct MortalFlight {
  explicit MortalFlight(int dies_at, Plan plan = {.edit = simulation::hand_rests}, Loss loss = Loss::Death)
      : flight{mortal(std::move(plan))} {
    deaths.at = dies_at;
    deaths.dies = [this, loss] {
      if (loss == Loss::Hang) hangs();
      else flight.craft().supervisor_dies_here();
    };
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
  /// To what the supervisor says.
  void listen() {
    flight.story().on_telemetry = [this](const pus::TelemetryView& report) {
      verdicts.hear(report);
      if (!flight.craft().supervisor_is_dying()) said.hear(report);
    };
  }
  /// As long as its keeper lets it: whoever cycles goes on meanwhile, and nobody loses a link for it.
  void hangs() {
    constexpr Duration members_change_their_states = 50ms;
    struct Member {
      std::string name;
      std::uint64_t cycles;
      std::uint32_t inhibited;
    };
    std::vector<Member> before;
    if (on_hang) on_hang();
    for (const auto& described : flight.mission().subsystems) {
      const std::string& name = described.subsystem.name;
      if (!flight.craft().alive(name) || flight.craft().vital(name)->cycling.load() == 0) continue;
      before.push_back({name, flight.cycles(name), flight.inhibited(name)});
    }
    flight.craft().supervisor_hangs_here(supervisor::supervisor_patience);
    hung_until = flight.craft().now();
    for (const auto& [name, cycles, inhibited] : before) {
      const auto* page = flight.craft().vital(name);
      if (page == nullptr || page->cycling.load() == 0) continue;
      const auto least =
          (supervisor::supervisor_patience - members_change_their_states) / Duration{page->period_ns.load()};
      EXPECT_GE(flight.cycles(name) - cycles, static_cast<std::uint64_t>(least)) << name << " cycles\n" << text();
      ++cycled_on;
      if (inhibited != 0 || !may_move(name.c_str())) continue;
      EXPECT_EQ(flight.inhibited(name) & ~may_be_inhibited_by, 0U) << name << " is let move, and is inhibited\n"
                                                                   << text();
      ++moved_on;
    }
  }
  [[nodiscard]] std::string text() { return "dies at " + std::to_string(deaths.at) + "\n" + flight.story().text(); }

  Deaths deaths;
  Verdicts verdicts;  ///< as the supervisor says, also one that is dying and will not have said so
  Verdicts said;  ///< without what one that is dying says, which is kept back
  Verdicts heard;  ///< as they came down
  std::function<void()> on_hang;  ///< as it begins
  std::uint32_t may_be_inhibited_by{0};  ///< meanwhile, as what it was lost in is about that
  std::optional<TimePoint> hung_until;
  int cycled_on{0}, moved_on{0};  ///< members, while it hung
  Flight flight;

 private:
  [[nodiscard]] Plan mortal(Plan plan) {
    plan.wrap_channel = [this](std::string_view, std::unique_ptr<Channel> channel) -> std::unique_ptr<Channel> {
      return std::make_unique<MortalChannel>(std::move(channel), deaths);
    };
    plan.revives_after = plan.revives_after.value_or(300ms);
    return plan;
  }
};

/// From a death until all has come to rest or goes on: 300 ms until another one is there, then the longest way down.
inline constexpr Duration settles = 1500ms;

[[nodiscard]] inline Plan hand_at_rest() { return {.edit = simulation::hand_rests}; }

/// Flies `plan` again and again, with a loss one moment later each time of those in the `span` that `begin` begins, until none comes any
/// more; the number of flights.
inline int at_every_moment(const std::function<void(MortalFlight&)>& begin,
                           const std::function<void(MortalFlight&)>& judge, int every = one_in(3),
                           const std::function<Plan()>& plan = hand_at_rest, Duration span = 1s,
                           Loss loss = Loss::Death) {
  int flights = 0;
  for (int at = 1;; at += every) {
    MortalFlight mortal{at, plan(), loss};
    Flight& flight = mortal.flight;
    mortal.listen();
    if (!flight.commission()) {
      ADD_FAILURE() << "not commissioned\n" << mortal.text();
      return flights;
    }
    flight.craft().run(100ms);
    flight.craft().ground().on_telemetry([&](Octets packet) {
      if (const auto report = pus::TelemetryView::parse(packet)) mortal.heard.hear(*report);
    });
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
