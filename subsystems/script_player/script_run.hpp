// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hirosco/pus/script/script.hpp"
#include "hirosco/subsystem/author/request_port.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco::script_player {

/// Values of the enumeration PROGRESS of script_player.xml.
enum class Progress : std::uint8_t { Idle = 0, Playing = 1, Held = 2, Ended = 3, Failed = 4, Aborted = 5 };

/// What a run does to the world, line by line of the script that is played.
class Stage {
 public:
  /// Sends the telecommand of a line, or asks for the parameter that it waits for: the number of the request. ResourceExhausted: later.
  [[nodiscard]] virtual Result<std::uint32_t> ask(std::size_t line) = 0;
  /// The number in what was answered; empty: there is none.
  [[nodiscard]] virtual std::optional<double> number_in(std::size_t line, Octets answered) = 0;
  /// The event that a line waits for was heard since forget_events().
  [[nodiscard]] virtual bool was_heard(std::size_t line) = 0;
  virtual void forget_events() = 0;

 protected:
  ~Stage() = default;
};

/// One script on its way: a line after the other, each begun when the one before has ended, until the first that fails.
/// Thread: the service loop.
class ScriptRun {
 public:
  /// Of a telecommand, until the script says another one.
  static constexpr double usual_limit_s = 60;

  /// From its first line on. `script` outlives the run.
  void begin(const pus::Script& script, TimePoint now);
  void step(TimePoint now, Stage& stage);
  /// What comes of a request; of one that is nobody's any more nothing.
  void hear(const RequestReport& report, TimePoint now, Stage& stage);
  /// Before the next line; what is under way comes to its end.
  void hold() noexcept { held_ = true; }
  void resume() noexcept { held_ = false; }
  /// Now, as `how`: nothing more is sent. What was sent goes on where it was sent to.
  void stop(Progress how, std::string why);

  [[nodiscard]] bool active() const noexcept { return progress_ == Progress::Playing; }
  [[nodiscard]] Progress progress() const noexcept;
  /// Number in the file of the line that is under way, or was the last; 0 before the first.
  [[nodiscard]] std::uint16_t line() const noexcept { return number_; }
  /// Lines that have ended.
  [[nodiscard]] std::size_t done() const noexcept { return next_; }
  /// Of the script: without what it was held between two lines.
  [[nodiscard]] double time_s() const noexcept { return time_s_; }
  /// Why it failed or was aborted, in words.
  [[nodiscard]] const std::string& why() const noexcept { return why_; }

 private:
  enum class Phase : std::uint8_t { Between, Asked, Waiting };
  void begin_line(TimePoint now, Stage& stage);
  void go_on(TimePoint now, Stage& stage);
  void look(TimePoint now, Stage& stage);
  void end_line() noexcept;
  void fail(const std::string& why);

  const pus::Script* script_{nullptr};
  Progress progress_{Progress::Idle};
  Phase phase_{Phase::Between};
  bool held_{false};
  std::size_t next_{0};
  std::uint16_t number_{0};
  double time_s_{0};
  double limit_s_{usual_limit_s};
  TimePoint last_{};
  TimePoint deadline_{};
  TimePoint next_look_{};
  std::optional<std::uint32_t> open_;  ///< the request whose end is waited for
  std::optional<double> seen_;  ///< of the parameter that is waited for
  std::string why_;
};

}  // namespace hirosco::script_player
