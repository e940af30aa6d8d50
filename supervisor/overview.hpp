// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"

/// How a craft does at one instant, as whoever shows it needs it: plain words and figures that outlive what they were taken from.
namespace hirosco::supervisor {

class Supervisor;

struct Overview {
  struct Member {
    std::string name;
    bool runs{false};
    std::string state{"not running"};
    std::string wanted{};  ///< state in which the mode has it; empty: the mode says nothing of it
    bool counted{false};  ///< the figures below were told
    bool cycling{false};
    bool realtime{false};
    std::uint32_t inhibited{0};  ///< bits of Inhibition
    std::uint64_t period_ns{0};
    std::uint64_t cycles{0}, overruns{0}, missed{0};
    std::uint32_t latency_max_ns{0}, execution_mean_ns{0};
    std::uint64_t inhibited_at_cycle{0}, stopped_at_cycle{0};
  };
  struct Link {
    std::uint8_t id{};
    std::string from, to;  ///< subsystems
    bool up{false};
    bool wanted{false};  ///< the mode establishes it
  };
  std::string mission;
  std::string mode;
  std::string initial_mode{};  ///< before anybody is commissioned
  std::string usual_mode{};  ///< in which a flight begins once it is commissioned; empty: it commissions nobody
  std::string waits_for{};  ///< on the way up or down; empty: for nothing
  std::vector<Member> members;
  std::vector<Link> links;
};

/// What the mission says of it: every member not running, every link down.
[[nodiscard]] Overview blank_overview(const descriptor::Mission& mission, const descriptor::Mode& mode);
/// Thread: the supervisor's.
[[nodiscard]] Overview overview_of(const descriptor::Mission& mission, const Supervisor& supervisor);
/// One JSON object without an end of line, of printable ASCII; `values`: label and words of what the mission's <Console> shows.
[[nodiscard]] std::string json_of(const Overview& overview, double up_s,
                                  const std::vector<std::pair<std::string, std::string>>& values);
/// A JSON string. Names and event texts come from descriptors: nothing but printable characters reaches a terminal.
[[nodiscard]] std::string json_string(std::string_view text);

}  // namespace hirosco::supervisor
