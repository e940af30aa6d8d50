// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "supervisor/supervision/command_desk.hpp"

/// A list of telecommands in stages: all of a stage are sent at once, the next stage waits for the last of them
/// (decision 5: commissioning uses the same telecommands as an operator).
namespace hirosco::supervisor {

class Sequence {
 public:
  struct Command {
    std::uint16_t apid{};
    std::string subsystem;
    std::string function;
    std::optional<double> argument;
    std::string text;                ///< "PreOperational", "configuration COUPLED", "link 1"
  };
  using Stage = std::vector<Command>;
  /// Called at the end: success, or the command that failed and why. With `go_on` failures do not stop the sequence.
  using Finished = std::function<void(bool success, const std::string& why)>;
  enum class OnFailure : std::uint8_t { Stop, GoOn };

  explicit Sequence(CommandDesk& desk) : desk_{desk} {}
  /// Replaces whatever was running.
  void start(std::vector<Stage> stages, OnFailure on_failure, Finished finished);
  void cancel();
  [[nodiscard]] bool running() const noexcept { return running_; }
  /// "ARM: link 1, HAND: Operational"; empty when nothing is awaited.
  [[nodiscard]] std::string waiting_for() const;

 private:
  void begin_stage();
  void ended(std::size_t command, bool success, const std::string& why);
  void finish(bool success, const std::string& why);

  CommandDesk& desk_;
  std::vector<Stage> stages_;
  std::size_t stage_{0};
  std::vector<bool> open_;
  std::size_t open_count_{0};
  OnFailure on_failure_{OnFailure::Stop};
  Finished finished_;
  std::string first_failure_;
  std::uint32_t run_{0};
  bool running_{false};
};

}  // namespace hirosco::supervisor
