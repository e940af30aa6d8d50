// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "supervisor/supervision/procedures/step.hpp"

/// Steps in stages: all of a stage are begun at once, the next stage waits for the last of them. The one model for
/// commissioning, shutdown, the care for the ground link and the plans of a mission (docs/adr/0057).
namespace hirosco::supervisor {

using Stage = std::vector<ProcedureStep>;

struct ProcedureEnd {
  bool success{true};
  std::string step{};  ///< the first that failed: "ARM PreOperational"
  std::string why{};
  [[nodiscard]] std::string text() const { return success ? std::string{} : step + ": " + why; }
};

struct Procedure {
  enum class OnFailure : std::uint8_t { Stop, GoOn };
  std::vector<Stage> stages;
  OnFailure on_failure{OnFailure::Stop};
  std::function<void(const ProcedureEnd&)> finished{};
  std::function<void(std::size_t stage)> begins{};  ///< counted from 0, those without a step not counted
  /// Who is stopped after it has begun is let go by none of its steps: whoever asked for it did not know of that.
  bool knows_of_no_stop{false};
};

/// Runs one procedure at a time. Whoever lets go of a runner does not end what it has begun; cancel() does.
/// Thread: the supervisor's.
class ProcedureRunner {
 public:
  explicit ProcedureRunner(const Means& means) : means_{means} {}
  /// Replaces whatever was running.
  void start(Procedure procedure);
  /// Nothing more is begun or told; what was begun goes on.
  void cancel();
  [[nodiscard]] bool running() const noexcept;
  /// Whoever runs it has fenced this one meanwhile: that is no stop by somebody else, unless there was one besides.
  /// \param fences The guard's count of its fences, with that one.
  void knows_of(std::uint16_t apid, std::uint64_t fences);
  /// "ARM: link 1, HAND: Operational"; empty when nothing is awaited.
  [[nodiscard]] std::string waiting_for() const;

 private:
  struct Run;
  Means means_;
  std::weak_ptr<Run>
      run_;  ///< kept by the answers that are still to come alone: who is told of its end may have this runner
};

}  // namespace hirosco::supervisor
