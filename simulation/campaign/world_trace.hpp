// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "simulation/campaign/plan.hpp"
#include "simulation/spacecraft/spacecraft.hpp"

/// What an outside observer saw of a flight, one line a change; its words are in the README.
namespace hirosco::campaign {

class WorldTrace {
 public:
  /// `origin`: what the flight's octets rest on, for its first line.
  WorldTrace(const descriptor::Mission& mission, simulation::Spacecraft& craft, std::uint32_t clock_percent,
             std::string_view origin);

  /// Looks around; call after each instant at which something happened.
  void look();
  template <class... Arguments>
  void say(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    text_ += fmt::format("{} ", now_us());
    fmt::format_to(std::back_inserter(text_), format, std::forward<Arguments>(arguments)...);
    text_ += '\n';
  }
  [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
  struct Member {
    std::string name;
    std::array<std::uint64_t, 5> seen{};  ///< alive, state, configuration, inhibited, cycling
    std::array<std::uint32_t, told_incoming_links> links{};
    std::string version{"-"};
    const std::string* text{nullptr};  ///< that it flies by
    std::uint64_t cycles{0};
    std::uint64_t period_ns{0};
    TimePoint moved{};
    bool still{true};
  };
  struct Device {
    std::string name;
    const simulation::SimulatedDevice* device{};
    bool active{false};
    bool turning{false};
    bool tripped{false};
  };

  [[nodiscard]] std::int64_t now_us() const;
  void look_at(Member& member);
  void look_at_program(Member& member);
  void look_at(Device& device);
  void look_at_links();
  void count_cycles();

  simulation::Spacecraft& craft_;
  std::vector<Member> members_;
  std::vector<Device> devices_;
  TimePoint next_count_{};
  bool supervised_{true};
  std::string links_up_;
  std::string text_;
};

}  // namespace hirosco::campaign
