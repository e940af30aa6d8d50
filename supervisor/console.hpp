// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdio>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "hirosco/pus/st03_housekeeping/housekeeping_decoder.hpp"
#include "supervisor/overview.hpp"
#include "supervisor/platform/launch/standard_error.hpp"
#include "supervisor/supervision/observer.hpp"

/// What a flight tells its terminal: the story of commissioning and recovery and, in lines, what has changed; or as JSON, for programs and
/// for the screen that another process draws (tools/terminal/).
namespace hirosco::supervisor {

class Console final : public Observer {
 public:
  /// Json: status every second, with all of housekeeping. Screen: four times a second, with what a screen shows.
  enum class Style : std::uint8_t { Text, Json, Quiet, Screen };
  static constexpr std::size_t most_told = 200;  ///< lines of one speaker in a second; the others are counted
  static constexpr std::size_t most_lines = 4096;  ///< that wait for a terminal that stands still
  /// `terminal` outlives it.
  Console(const descriptor::Mission& mission, Style style, std::FILE* terminal = stdout);
  ~Console() override;

  void told(OnboardTime when, std::string_view line) override;
  void routed(const pus::TelemetryView& packet) override;
  /// How often it wants to show().
  [[nodiscard]] Duration period() const noexcept { return style_ == Style::Screen ? Duration{250ms} : Duration{1s}; }
  /// Call about once in a period from the supervisor's thread.
  void show(const Overview& overview, Duration since_start);
  /// The flight is over: its figures, where people read lines.
  void ended();

 private:
  void print(std::string line);
  void tell_held();
  [[nodiscard]] std::string held_text(const std::string& line) const;
  void write_lines();
  void tell_changes(const Overview& overview, Duration since_start);
  [[nodiscard]] std::string status_json(const Overview& overview, Duration since_start) const;
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> shown_values() const;

  const descriptor::Mission& mission_;
  Style style_;
  std::FILE* terminal_;
  OnboardTime first_{};
  LineLimit limit_{most_told};  ///< of one speaker in a second
  Duration next_turn_{0}, next_counts_{0};
  std::map<std::string, Overview::Member> cycled_;  ///< the newest figures of each, by name
  std::map<std::string, std::string> standing_;  ///< what was told last, by what it is about
  std::map<std::uint16_t, pus::HousekeepingDecoder> decoders_;
  std::map<std::string, pus::HousekeepingValue> values_;  ///< newest, by "SUBSYSTEM.PARAMETER"
  // A stopped terminal must not stop the supervisor: lines wait here for a thread of their own, oldest out first.
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::string> lines_;
  std::size_t dropped_{0};  ///< since the terminal took something last
  bool ending_{false};
  std::thread writer_;
};

}  // namespace hirosco::supervisor
