// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/modes/sequence.hpp"

namespace hirosco::supervisor {

/// From Offline to the start mode of the mission: the supervisor first, then all that the mode names, with the telecommands
/// that an operator would use (decision 5). Thread: the supervisor's.
class Commissioning {
 public:
  Commissioning(Craft& craft, CommandDesk& desk) : craft_{craft}, sequence_{desk} {}

  /// `failed` is called when the supervisor itself cannot be commissioned.
  void start(std::function<void()> failed);
  /// It would go on with what was taken down or stopped as if nothing had happened. False: it is over already.
  bool cancel(std::string_view why);
  /// The shutdown takes over.
  void drop() { sequence_.cancel(); }

  [[nodiscard]] bool running() const noexcept { return sequence_.running(); }
  [[nodiscard]] bool succeeded() const noexcept { return succeeded_; }
  [[nodiscard]] std::string waiting_for() const { return sequence_.waiting_for(); }

 private:
  void commission(const descriptor::Mode& start_mode);
  void ended(const descriptor::Mode& start_mode, const std::string& failure);

  Craft& craft_;
  Sequence sequence_;
  bool succeeded_{false};
};

}  // namespace hirosco::supervisor
