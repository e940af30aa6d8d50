// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/procedures/procedure_runner.hpp"

namespace hirosco::supervisor {

/// From Offline to the start mode of the mission: the supervisor first, then all that the mode names, with the telecommands
/// that an operator would use (decision 5). Thread: the supervisor's.
class Commissioning final : public Undertaking {
 public:
  explicit Commissioning(const Means& means)
      : craft_{means.craft}, links_{means.links}, runner_{means}, itself_{means} {}

  /// `failed` is called when the supervisor itself cannot be commissioned.
  void start(std::function<void()> failed);
  /// Of a supervisor that goes on for another: itself alone. `done` is told whether it is Operational.
  void start_itself(std::function<void(bool)> done);
  void succeeded_before() noexcept { succeeded_ = true; }
  Cancelled cancel(std::string_view why) override;
  void all_stopped(std::string_view why) override { static_cast<void>(cancel(why)); }
  /// The shutdown takes over.
  void drop();

  [[nodiscard]] bool running() const noexcept { return begins_ || runner_.running(); }
  [[nodiscard]] bool succeeded() const noexcept { return succeeded_; }
  [[nodiscard]] std::string waiting_for() const { return begins_ ? itself_.waiting_for() : runner_.waiting_for(); }

 private:
  void commission(const descriptor::Mode& start_mode);
  void ended(const descriptor::Mode& start_mode, const std::string& failure);

  Craft& craft_;
  const LinkGraph& links_;
  ProcedureRunner runner_;
  ProcedureRunner itself_;  ///< which no stop ends
  bool begins_{false};  ///< the others follow when the supervisor itself is there
  bool succeeded_{false};
};

}  // namespace hirosco::supervisor
