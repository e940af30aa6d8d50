// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "supervisor/supervision/command_desk.hpp"

namespace hirosco::supervisor::testing {

/// Keeps what it is asked to send; the test answers, or it answers at once.
struct PlayedDesk final : CommandDesk {
  using CommandDesk::command;
  void command(std::uint16_t apid, std::string_view function, std::optional<double> argument, CommandDone done,
               std::optional<std::uint64_t> free_at) override {
    std::string text = std::to_string(apid);
    text.append(1, ' ').append(function);
    if (argument) text.append(1, ' ').append(std::to_string(static_cast<int>(*argument)));
    if (on_command) on_command();
    sent.push_back(text);
    counts.push_back(free_at);
    answers.push_back(std::move(done));
    if (at_once) answers.back()(*at_once, "at once");
  }
  void send(std::uint16_t apid, std::uint8_t service, std::uint8_t subtype, Octets, const MemoryHandle&,
            CommandDone done, Duration takes) override {
    sent.push_back(std::to_string(apid) + " TC[" + std::to_string(service) + "," + std::to_string(subtype) + "] " +
                   std::to_string(takes / std::chrono::milliseconds{1}) + " ms");
    answers.push_back(std::move(done));
    if (at_once) answers.back()(*at_once, "at once");
  }
  /// The oldest that was not answered.
  void answer(bool success, const std::string& why = {}) {
    const CommandDone done = std::move(answers.front());
    answers.erase(answers.begin());
    done(success, why);
  }

  std::vector<std::string> sent;
  std::vector<std::optional<std::uint64_t>> counts;  ///< of functions: the fences that their sender knows of
  std::vector<CommandDone> answers;
  std::optional<bool> at_once;
  std::function<void()> on_command{};  ///< looks at what holds when something is sent
};

}  // namespace hirosco::supervisor::testing
