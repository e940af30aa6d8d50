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
#include "supervisor/platform/launch/standard_error.hpp"
#include "supervisor/supervisor.hpp"

/// What a person at the terminal sees: the story of commissioning and recovery, then a live line every second.
namespace hirosco::supervisor {

class Console final : public Observer {
 public:
  enum class Style : std::uint8_t { Text, Json, Quiet };
  static constexpr std::size_t most_told = 200;    ///< lines of one speaker in a second; the others are counted
  static constexpr std::size_t most_lines = 4096;  ///< that wait for a terminal that stands still
  /// `terminal` outlives it.
  Console(const descriptor::Mission& mission, Style style, std::FILE* terminal = stdout);
  ~Console() override;

  void told(OnboardTime when, std::string_view line) override;
  void routed(const pus::TelemetryView& packet) override;
  /// One live status line; call about once a second from the supervisor's thread.
  void show(const Supervisor& supervisor, Duration since_start);

 private:
  void print(std::string line);
  void tell_held();
  [[nodiscard]] std::string held_text(const std::string& line) const;
  void write_lines();
  [[nodiscard]] std::string status_text(const Supervisor& supervisor, Duration since_start) const;
  [[nodiscard]] std::string status_json(const Supervisor& supervisor, Duration since_start) const;

  const descriptor::Mission& mission_;
  Style style_;
  std::FILE* terminal_;
  OnboardTime first_{};
  LineLimit limit_{most_told};       ///< of one speaker from status line to status line, once a second
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
