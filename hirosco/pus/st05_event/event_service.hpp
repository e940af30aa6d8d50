// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/pus/st01_verification/verification.hpp"
#include "hirosco/utilities/result.hpp"

namespace hirosco::pus {

/// ST[05]: reports events and lets their reports be switched (ECSS-E-ST-70-41C 8.5.2; README.md). A disabled event is still an event: whoever
/// reacts to it does so before or beside raise().  Thread: the service loop.
class EventService final : public Service {
 public:
  static constexpr std::uint8_t service_type = 5;
  enum Subtype : std::uint8_t { enable_reports = 5, disable_reports = 6, report_disabled = 7, disabled_list = 8 };

  EventService(const std::vector<descriptor::Event>& events, Verification& verification, TelemetrySink& sink);

  /// Sends TM[5,severity] unless the report is disabled. `auxiliary_data`: the declared arguments, big-endian.
  /// NotFound: no such event; Mismatch: not the length that its arguments have.
  [[nodiscard]] Result<> raise(std::uint16_t event_id, Octets auxiliary_data);
  /// False also for an unknown event.
  [[nodiscard]] bool report_enabled(std::uint16_t event_id) const noexcept;
  /// Without a telecommand: as it was switched in a process before this one. Nothing for an unknown event.
  void set_reported(std::uint16_t event_id, bool reported) noexcept;

  static const ServiceKind service_kind;
  [[nodiscard]] const ServiceKind& kind() const noexcept override { return service_kind; }
  void handle(const TelecommandView& telecommand, const Request& request) override;

 private:
  struct Definition {
    std::uint16_t id{};
    descriptor::Severity severity{};
    std::size_t octets{};  ///< of the auxiliary data
    bool enabled{true};
  };
  [[nodiscard]] Definition* find(std::uint16_t event_id) noexcept;
  void switch_reports(Octets data, const Request& request, bool enabled);
  void report_disabled_events(const Request& request);

  std::vector<Definition> events_;
  Verification& verification_;
  TelemetrySink& sink_;
};

/// Encodes an event's arguments (arrays: all their elements) from numbers in declared order. Integers are truncated and
/// held at the ends of their range: an anomaly is never lost because a value is. InvalidArgument: not as many values as
/// declared; ResourceExhausted: buffer too small.  Realtime: bounded.
[[nodiscard]] Result<Octets> encode_arguments(const descriptor::Event& event, std::span<const double> values,
                                              MutableOctets buffer) noexcept;

/// The same for whoever cannot refuse: values that are missing are 0, those too many are left out. The buffer has room for
/// octets_of(event).  Realtime: bounded.
[[nodiscard]] Octets fill_arguments(const descriptor::Event& event, std::span<const double> values,
                                    MutableOctets buffer) noexcept;
/// Octets of an event's auxiliary data.
[[nodiscard]] std::size_t octets_of(const descriptor::Event& event) noexcept;

}  // namespace hirosco::pus
