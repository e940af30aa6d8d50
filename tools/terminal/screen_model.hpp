// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/terminal/verdict.hpp"

/// What a screen knows of its flight, from the lines that it tells, and what the person at its keys wants. Bounded; does no input or output.
namespace hirosco::terminal {

/// A line of the story.
struct ScreenEvent {
  std::optional<double> at_s;  ///< since the first; empty: of no time, as what a process prints as an error
  Severity severity{Severity::Info};
  std::string text;
};

enum class Key : std::uint8_t { None, End, Filter, Stop, Up, Down, PageUp, PageDown, Newest, Redraw, Other };
/// Takes the first key off `octets`, which are not empty.
[[nodiscard]] Key take_key(std::string_view& octets);

/// What somebody outside has to do for a key.
enum class Wish : std::uint8_t { None, EndFlight, StopActuators, DrawAnew };

class ScreenModel {
 public:
  static constexpr std::size_t most_events = 2000;
  static constexpr std::size_t longest_text = 500;  ///< octets of a line that are kept
  static constexpr std::size_t most_errors = 20;

  /// A line of the supervisor, or of another process of the flight: JSON as their --screen and --json say, else words, which are an error.
  void take(std::string_view line);
  Wish press(Key key, std::size_t page_rows);
  [[nodiscard]] bool heard() const noexcept { return heard_ != 0; }
  [[nodiscard]] std::uint64_t overviews() const noexcept { return heard_; }  ///< how many have come
  [[nodiscard]] const Overview& overview() const noexcept { return overview_; }
  [[nodiscard]] double up_s() const noexcept { return up_s_; }
  [[nodiscard]] const std::vector<std::pair<std::string, std::string>>& values() const noexcept { return values_; }
  [[nodiscard]] const std::string& url() const noexcept { return url_; }
  [[nodiscard]] const std::string& observer_url() const noexcept { return observer_url_; }
  [[nodiscard]] const std::deque<ScreenEvent>& events() const noexcept { return events_; }
  /// What processes said as errors, the newest: for whoever has no screen any more.
  [[nodiscard]] const std::deque<std::string>& errors() const noexcept { return errors_; }
  [[nodiscard]] std::size_t grave_events() const noexcept { return grave_; }  ///< of medium and high severity
  [[nodiscard]] const std::optional<ScreenEvent>& gravest() const noexcept {
    return gravest_;
  }  ///< the newest of the gravest
  [[nodiscard]] bool only_low_and_up() const noexcept { return only_low_and_up_; }
  [[nodiscard]] std::size_t scrolled() const noexcept { return scrolled_; }  ///< events below the last that is seen
  [[nodiscard]] bool asks_for_end() const noexcept { return asks_; }
  [[nodiscard]] bool ending() const noexcept { return ends_; }
  /// The newest overview before the end began: how it was, once it is over.
  [[nodiscard]] const Overview& at_work() const noexcept { return at_work_; }
  [[nodiscard]] bool admits(const ScreenEvent& event) const noexcept {
    return !only_low_and_up_ || event.severity >= Severity::Low;
  }

 private:
  void add(ScreenEvent event);

  Overview overview_, at_work_;
  double up_s_{0};
  std::uint64_t heard_{0};
  std::vector<std::pair<std::string, std::string>> values_;
  std::string url_, observer_url_;
  std::deque<ScreenEvent> events_;
  std::deque<std::string> errors_;
  std::size_t grave_{0};
  std::optional<ScreenEvent> gravest_;
  bool only_low_and_up_{false};
  std::size_t scrolled_{0};
  bool asks_{false}, ends_{false};
};

}  // namespace hirosco::terminal
