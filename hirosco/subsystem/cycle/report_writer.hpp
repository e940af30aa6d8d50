// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"
#include "hirosco/subsystem/cycle/loop_rings.hpp"

namespace hirosco {

/// All that the cycle reports, into the rings that the service loop takes it from. Answers and events are numbered together; what an
/// author says never takes the room of what somebody waits for, nor of what the framework has to tell.
/// Realtime: bounded, no allocation. Thread: the cycle's.
class ReportWriter final : public pus::SampleSink {
 public:
  /// `events`: of the descriptor, the framework's included.
  ReportWriter(const std::vector<descriptor::Event>& events, LoopRings& rings);

  void raise(std::uint16_t event, std::span<const double> arguments) noexcept;
  /// The same with its auxiliary data; nothing when these have not the length of the descriptor's.
  void raise_encoded(std::uint16_t event, Octets auxiliary) noexcept;
  void report(ReportKind kind, std::uint16_t index, const pus::Request& request, AttachedLink* link = nullptr) noexcept;
  /// A function was refused, or ends without success.
  void fail_call(ReportKind kind, pus::FailureCode code, const pus::Request& request, const Error& why) noexcept;
  /// A step of a function that goes on has failed.
  void fail_step(std::uint16_t step, pus::FailureCode code, const pus::Request& request, const Error& why) noexcept;
  /// One of the kinds whose payload says why, as AuthorsError; its number is given here.
  void explain(const CycleReport& head, const Error& why) noexcept;

  // --- housekeeping, one report at a time -----------------------------------------------------------------------------
  MutableOctets reserve(std::size_t octets) noexcept override;
  void commit(std::uint16_t structure, std::size_t octets) noexcept override;

 private:
  void raise_found(const descriptor::Event& event, Octets auxiliary) noexcept;
  void answer(CycleReport head, Octets payload = {}) noexcept;

  const std::vector<descriptor::Event>& events_;
  LoopRings& rings_;
  std::vector<std::byte> event_buffer_;  ///< room for the largest event of the descriptor
  std::uint32_t report_number_{0};
  MutableOctets reserved_;  ///< housekeeping report under assembly
};

}  // namespace hirosco
