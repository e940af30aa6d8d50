// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <expected>
#include <optional>

#include "hirosco/subsystem/service_loop/configurations.hpp"
#include "hirosco/subsystem/service_loop/introduction.hpp"

namespace hirosco {

class CycleReports;

/// The ten states of a subsystem: commands, the phases of transient states, what fails on the way (paper figure 4).
/// Thread: the service loop.
class StateMachine {
 public:
  struct Parts {
    Subsystem& author;
    const descriptor::SubsystemDescriptor& descriptor;
    const Platform& platform;
    CycleLoop& cycle;
    LoopRings& rings;
    CycleOrders& orders;
    VitalPage& vital;
    const PermitPages& permit;
    ParameterValues& values;
    Introduction& introduction;
    LinkEnds& links;
    Configurations& configurations;
    SelfTests& self_tests;
    Reports& reports;
    CycleReports& cycle_reports;  ///< what the cycle said before it came to rest
  };
  StateMachine(Situation& at, const Parts& parts) : at_{at}, parts_{parts} {}

  /// A notice: refused, nothing was begun. Else it has begun and ends by its own report, of a failure, too, and perhaps at once.
  std::expected<void, pus::FailureNotice> command(State target, const pus::Request& request);
  /// Goes on with what is under way.
  void advance(TimePoint now);
  /// A configuration that the cycle still held when Post-Operational ran out of time is given back once it rests; what else the way to
  /// Offline left behind, pools of which blocks are held among it, in Offline.
  void release_late();
  /// What is done when nobody supervises any more, by what PermitPages has watched.
  void react_to_silence();
  /// Offline again after the supervisor went away or said so: the process may end.
  [[nodiscard]] bool finished() const noexcept { return finished_; }

  // --- what the cycle says -------------------------------------------------------------------------------------------
  void cycle_entered(State state);
  /// Whether it was sent into this state and has not answered.
  [[nodiscard]] bool awaits(State state) const noexcept {
    return awaiting_cycle_ && at_.way && state == at_.way->states[way_at_];
  }
  /// One that it awaits(): whoever says it has asked.
  void cycle_refused(State state, const Failure& why);
  void node_failed(State state, const Failure& why);

 private:
  void go(State target, std::optional<pus::Request> request);
  bool run_phase(State next, TimePoint now);
  void arrive(State state);
  void be_in(State state);
  void arrive_transient(State state);
  void go_down_from(State failed);
  void fail_transition(State failed, const Failure& why);
  void look_for_first_answer();
  [[nodiscard]] Failure never_answered_failure(const DeviceInputs::NeverAnswered& device) const;
  Result<Step> enter_transient(State next);
  Result<Step> leave_cycle();
  /// Whether the switches of its devices say so; for who has none: always.
  [[nodiscard]] bool powered(Power wanted) const noexcept;
  [[nodiscard]] bool power_takes_too_long() const noexcept;

  Situation& at_;
  Parts parts_;
  std::uint8_t way_at_{0};
  std::optional<pus::Request> way_request_;
  bool phase_entered_{false};
  bool awaiting_cycle_{false};
  bool answer_owed_{false};  ///< the cycle is where it was sent, and waits for the first answer of a device
  TimePoint phase_deadline_{};
  bool finished_{false};
};

}  // namespace hirosco
