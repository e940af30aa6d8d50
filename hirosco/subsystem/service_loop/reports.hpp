// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string_view>

#include "hirosco/data_transfer/channel/channel.hpp"
#include "hirosco/pus/packet/packet_counters.hpp"
#include "hirosco/pus/st01_verification/verification.hpp"
#include "hirosco/pus/st05_event/event_service.hpp"
#include "hirosco/subsystem/cycle/loop_rings.hpp"
#include "hirosco/subsystem/pages/pages.hpp"
#include "hirosco/subsystem/service_loop/backlog.hpp"
#include "hirosco/subsystem/service_loop/failure.hpp"
#include "hirosco/utilities/os/clock.hpp"

namespace hirosco {

/// What a subsystem says to its supervisor: reports, which it stamps and numbers, and events; kept while the supervisor does not take
/// them.  Thread: the service loop.
class Reports final : public pus::TelemetrySink {
 public:
  Reports(const descriptor::SubsystemDescriptor& descriptor, const Clock& clock, Channel& channel, VitalPage& vital);
  Reports(const Reports&) = delete;
  Reports& operator=(const Reports&) = delete;

  [[nodiscard]] pus::Verification& verification() noexcept { return verification_; }
  /// ST[05], one that listens to events and may be told to be silent (adr 0020).
  [[nodiscard]] pus::EventService& event_service() noexcept { return event_service_; }

  void report(std::uint8_t service, std::uint8_t subtype, std::uint16_t destination, Octets source_data) override;
  /// An event by its id; nothing when the descriptor declares none.
  void raise_encoded(std::uint16_t event, Octets auxiliary);
  void raise(std::uint16_t event, std::span<const double> arguments);
  /// By its name, which is known before Software-Init has bound an id, with the octets that its arguments take; nothing when the descriptor declares none such.
  void raise_named(std::string_view event, Octets auxiliary);
  /// By its name, with numbers; nothing when the descriptor declares none such.
  void announce(std::string_view event, std::initializer_list<double> arguments);
  /// STATE_FAILED and CONFIGURATION_FAILED of `what`.
  void raise_failure(std::uint16_t event, std::uint8_t what, const Failure& why);

  /// A failure as ground reads it: a code that nobody can look up says nothing, and becomes an execution error that names it.
  [[nodiscard]] pus::FailureNotice notice_of(std::uint16_t code, const pus::Reason& why) const noexcept;

  /// REPORTS_LOST, where more were lost since it was raised last.
  void tell_losses(TimePoint now, const LoopRings& of_cycle, std::uint64_t of_own_loops);
  void flush() { backlog_.flush(channel_); }
  /// Backlog::take_most_waiting().
  [[nodiscard]] descriptor::Waiting take_most_waiting() noexcept { return backlog_.take_most_waiting(); }
  /// How full the channel was, by what waits in it now and whether it refused something since this was asked last: kB where its descriptor
  /// says how many, else in the channel's own unit.
  [[nodiscard]] QueueFill take_channel_fill() noexcept;
  /// Nothing waits for the supervisor.
  [[nodiscard]] bool empty() const noexcept { return backlog_.empty(); }
  /// Backlog::answers_have_room().
  [[nodiscard]] bool answers_have_room() const noexcept { return backlog_.answers_have_room(); }

 private:
  const descriptor::SubsystemDescriptor& descriptor_;
  const Clock& clock_;
  Channel& channel_;
  pus::PacketCounters counters_;
  pus::Verification verification_;
  pus::EventService event_service_;
  Backlog backlog_;
  FillMark channel_mark_;
  std::array<std::uint64_t, 6> told_losses_{};
  TimePoint losses_told_at_{};
};

}  // namespace hirosco
