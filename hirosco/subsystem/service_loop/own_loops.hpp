// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "hirosco/subsystem/service_loop/own_loop.hpp"
#include "hirosco/subsystem/service_loop/parameter_values.hpp"
#include "hirosco/subsystem/service_loop/reports.hpp"

namespace hirosco {

/// The loops of services of its own that a subsystem has (adr 0096), as its service loop sees them.
/// Thread: the service loop, where nothing else is said.
class OwnLoops {
 public:
  struct Parts {
    const descriptor::SubsystemDescriptor& descriptor;
    pus::ServiceHome& subsystem;
    const VitalPage& vital;
    const PermitPage& permit;
    const Clock& clock;
    ParameterValues& values;
    LoopMeter& meter;
  };
  explicit OwnLoops(const Parts& parts);
  OwnLoops(const OwnLoops&) = delete;
  OwnLoops& operator=(const OwnLoops&) = delete;

  /// As many from now to the end.  Thread: any.
  [[nodiscard]] const std::vector<std::unique_ptr<OwnLoop>>& all() const noexcept { return loops_; }
  /// The one that the service of this type is in; null: it is in none.
  [[nodiscard]] OwnLoop* of(std::uint8_t type) noexcept;
  /// Where the service of this type is at home: in one of them, or with the subsystem.
  [[nodiscard]] pus::ServiceHome& home_of(std::uint8_t type) noexcept;
  /// Of the subsystem's services, which may become more, those that are in none. Asked in each step: of which each is, is asked once.
  [[nodiscard]] const std::vector<pus::Service*>& in_none(const std::vector<pus::Service*>& services);
  /// They go as this configuration says, null: as their subsystem does. While they rest (LoopsAtRest).
  void follow(const descriptor::Configuration* in_force) noexcept;
  /// Another supervisor's page counts from now on.
  void take_permit(const PermitPage& page) noexcept;
  /// One has said what tell() has not told yet.  Realtime: wait-free. Thread: any.
  [[nodiscard]] bool has_reports() const noexcept;
  /// What their services have said.
  void tell(Reports& reports);
  [[nodiscard]] std::uint64_t lost() const noexcept;
  /// Of all of them, since it was asked last (OwnLoop::heap_uses()).
  [[nodiscard]] AllocationCount take_heap_uses() noexcept;
  /// Of the loop that is fullest on this way, since it was asked last; nothing where there is none.
  [[nodiscard]] OwnLoop::Fills take_fills() noexcept;
  /// False while one of them stands still within a step: then the supervisor's guard sees the service loop stand still.
  [[nodiscard]] bool move(TimePoint now, Reports& reports);

 private:
  const descriptor::SubsystemDescriptor& descriptor_;
  pus::ServiceHome& subsystem_;
  const Clock& clock_;
  std::vector<std::unique_ptr<OwnLoop>> loops_;
  std::vector<pus::Service*> in_none_;
  std::size_t sorted_{0};  ///< services of which it is known whether they are in one
  TimePoint looked_at_;
  AllocationCount told_uses_{};
};

}  // namespace hirosco
