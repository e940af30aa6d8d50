// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "hirosco/subsystem/author/handler.hpp"
#include "subsystems/manipulator/control/programme.hpp"
#include "subsystems/manipulator/setpoint.hpp"

namespace hirosco::manipulator {

/// What the arm does by itself for who asked for it, until it is measured there: a motion along a path, or a programme; beside a motion, or
/// within a programme, what its tool is to hold. It reports nothing: it says who is to be told what.
/// Realtime: bounded, no allocation. Thread: the cycle, and the service loop while there is none.
class Tasks {
 public:
  struct Parts {
    const Drives& drives;
    Setpoint& setpoint;
    const Parameters& parameters;  ///< GOAL_TOLERANCE
  };
  /// What a cycle has brought to a call, in the order in which it is told.
  struct News {
    enum class End : std::uint8_t {
      None,  ///< not yet
      There,
      Missed,  ///< its path has ended, and it is not there
      ToolHolds,
      ToolFailed,  ///< the device has not done it; a programme ends with it
    };
    Call call{};
    std::optional<std::uint16_t> step{};
    End end{End::None};
  };
  explicit Tasks(const Parts& parts) noexcept : parts_{parts} {}

  [[nodiscard]] bool moves() const noexcept { return move_ || programme_ != nullptr; }
  [[nodiscard]] bool tool_in_use() const noexcept { return tool_call_ || programme_ != nullptr; }
  /// What the tool is to hold now.
  [[nodiscard]] std::uint8_t tool() const noexcept {
    return tool_.busy() ? tool_.wanted() : parts_.drives.sensed().tool;
  }

  // --- functions: each while what it needs is free ------------------------------------------------------------------------
  /// Half-way is step 1.
  void move(const Joints& target_rad, double duration_s, const Call& call) noexcept;
  /// Each leg is a step. `programme` outlives it.
  void run(Programme& programme, const Call& call) noexcept;
  void use_tool(std::uint8_t wanted, const Call& call) noexcept;

  // --- in each cycle of Operational ---------------------------------------------------------------------------------------
  /// Where it leads is asked of the setpoint.
  [[nodiscard]] News advance(double span_s) noexcept;
  /// Waits for the device to hold what was asked for.
  [[nodiscard]] News watch_tool() noexcept;

  /// The setpoint stays where it is. Calls `abort(call)` for each that ran.
  template <class Abort>
  void stop(const Abort& abort) noexcept {
    parts_.setpoint.hold();
    if (programme_call_) tool_call_.reset();  // it is the same call
    programme_ = nullptr;
    tool_.forget();
    for (auto* call : {&move_, &programme_call_, &tool_call_}) {
      if (!*call) continue;
      abort(**call);
      call->reset();
    }
  }
  /// Whatever ran: nobody is told.
  void forget() noexcept;

 private:
  [[nodiscard]] News advance_motion(double span_s) noexcept;
  [[nodiscard]] News advance_programme(double span_s) noexcept;
  [[nodiscard]] News::End arrive(std::optional<Call>& call, const Joints& goal_rad, double span_s) noexcept;

  Parts parts_;
  Arrival arrival_;
  ToolWatch tool_;
  Programme* programme_{nullptr};
  std::size_t reported_leg_{0};
  std::optional<Call> programme_call_, move_;
  std::optional<Call> tool_call_;  ///< of the programme while one runs
  bool half_reported_{false};
};

}  // namespace hirosco::manipulator
