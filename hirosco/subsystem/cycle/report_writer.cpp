// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include "hirosco/subsystem/cycle/report_writer.hpp"

#include <algorithm>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/pus/st05_event/event_service.hpp"

namespace hirosco {
namespace {

[[nodiscard]] Octets octets_of_report(const CycleReport& report) noexcept {
  return std::as_bytes(std::span{&report, 1});
}

}  // namespace

ReportWriter::ReportWriter(const std::vector<descriptor::Event>& events, LoopRings& rings)
    : events_{events}, rings_{rings} {
  std::size_t largest = 0;
  for (const auto& event : events_) largest = std::max(largest, pus::octets_of(event));
  event_buffer_.resize(largest);
}

void ReportWriter::raise(std::uint16_t event, std::span<const double> arguments) noexcept {
  const auto found = std::ranges::find(events_, event, &descriptor::Event::id);
  if (found == events_.end()) return;
  raise_found(*found, pus::fill_arguments(*found, arguments, event_buffer_));
}

void ReportWriter::raise_encoded(std::uint16_t event, Octets auxiliary) noexcept {
  const auto found = std::ranges::find(events_, event, &descriptor::Event::id);
  if (found != events_.end() && pus::octets_of(*found) == auxiliary.size()) raise_found(*found, auxiliary);
}

void ReportWriter::raise_found(const descriptor::Event& event, Octets auxiliary) noexcept {
  CycleReport head{.kind = ReportKind::Event, .index = event.id};
  // A lost device or a stale link is told whatever the author raises besides.
  if (event.id >= descriptor::framework_event::first) return answer(head, auxiliary);
  RecordRing& ring = rings_.events;
  if (event.severity < descriptor::Severity::Medium && ring.used() > ring.capacity() / 2) {
    rings_.lost_remarks.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  head.number = ++report_number_;
  static_cast<void>(ring.try_write(octets_of_report(head), auxiliary));
}

void ReportWriter::report(ReportKind kind, std::uint16_t index, const pus::Request& request,
                          AttachedLink* link) noexcept {
  answer({.kind = kind, .index = index, .request = request, .link = link});
}

void ReportWriter::fail_call(ReportKind kind, pus::FailureCode code, const pus::Request& request,
                             const Error& why) noexcept {
  explain({.kind = kind, .index = static_cast<std::uint16_t>(code), .request = request}, why);
}

void ReportWriter::fail_step(std::uint16_t step, pus::FailureCode code, const pus::Request& request,
                             const Error& why) noexcept {
  const FailedStep failed{AuthorsError{why}, step};
  answer({.kind = ReportKind::StepFailed, .index = static_cast<std::uint16_t>(code), .request = request},
         std::as_bytes(std::span{&failed, 1}));
}

void ReportWriter::explain(const CycleReport& head, const Error& why) noexcept {
  const AuthorsError error{why};
  answer(head, std::as_bytes(std::span{&error, 1}));
}

void ReportWriter::answer(CycleReport head, Octets payload) noexcept {
  RecordRing& answers = rings_.answers;
  // Progress is all that an author can have without end: it never takes the last half.
  const bool endless = head.kind == ReportKind::Progressed || head.kind == ReportKind::StepFailed;
  if (endless && answers.used() + payload.size() > answers.capacity() / 2) {
    rings_.lost_progress.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  head.number = ++report_number_;
  static_cast<void>(answers.try_write(octets_of_report(head), payload));
}

MutableOctets ReportWriter::reserve(std::size_t octets) noexcept {
  reserved_ = rings_.housekeeping.try_reserve(sizeof(CycleReport) + octets);
  return reserved_.empty() ? MutableOctets{} : reserved_.subspan(sizeof(CycleReport));
}

void ReportWriter::commit(std::uint16_t structure, std::size_t octets) noexcept {
  // reserve() left room for the head in front of what it handed out.
  const CycleReport head{.kind = ReportKind::Housekeeping, .index = structure};
  std::ranges::copy(octets_of_report(head), reserved_.begin());
  rings_.housekeeping.commit(sizeof head + octets);
}

}  // namespace hirosco
