// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/cycle_reports.hpp"

#include <algorithm>
#include <cstring>

#include "hirosco/subsystem/service_loop/state_machine.hpp"

namespace hirosco {
namespace {

/// Of two numbers that count on past their end.
[[nodiscard]] constexpr bool comes_before(std::uint32_t a, std::uint32_t b) noexcept {
  return static_cast<std::int32_t>(a - b) < 0;
}

/// What an author said, as it came; it lasts as long as this, and needs no heap.
class SaidFailure {
 public:
  explicit SaidFailure(Octets payload) noexcept {
    std::memcpy(&said_, payload.data(), std::min(payload.size(), sizeof said_));
  }
  [[nodiscard]] pus::Reason reason() const noexcept {
    return {said_.code, said_.number, {said_.text.data(), said_.text_octets}};
  }
  /// In words of its own, for whoever changes its state by it.
  [[nodiscard]] Failure kept() const { return {said_.code, std::string{reason().text}, said_.number}; }

 private:
  AuthorsError said_;
};

[[nodiscard]] std::uint16_t step_in(Octets payload) noexcept {
  FailedStep failed;
  std::memcpy(&failed, payload.data(), std::min(payload.size(), sizeof failed));
  return failed.step;
}

}  // namespace

void CycleReports::take() {
  parts_.rings.look();
  const auto head_of = [](Octets record) {
    CycleReport head;
    std::memcpy(&head, record.data(), sizeof head);
    return head;
  };
  const auto take = [&](RecordRing& ring, const CycleReport& head, Octets record) {
    take_one(head, record.subspan(sizeof head));
    ring.pop();
  };
  for (;;) {
    const auto event = parts_.rings.events.front();
    // Looked at last: an answer that was made before this event is seen, too.
    const auto answer = parts_.rings.answers.front();
    if (!event && !answer) break;
    const bool answer_first = answer && (!event || comes_before(head_of(*answer).number, head_of(*event).number));
    if (answer_first) take(parts_.rings.answers, head_of(*answer), *answer);
    else take(parts_.rings.events, head_of(*event), *event);
  }
  while (const auto record = parts_.rings.housekeeping.front())
    take(parts_.rings.housekeeping, head_of(*record), *record);
}

void CycleReports::take_one(const CycleReport& head, Octets payload) {
  switch (head.kind) {
    case ReportKind::Housekeeping: parts_.reports.report(3, 25, 0, payload); break;
    case ReportKind::Event: parts_.reports.raise_encoded(head.index, payload); break;
    case ReportKind::Started: parts_.calls.started(head.request); break;
    case ReportKind::Refused:
      parts_.calls.refused(head.request, parts_.reports.notice_of(head.index, SaidFailure{payload}.reason()));
      break;
    case ReportKind::Progressed: parts_.reports.verification().progressed(head.request, head.index); break;
    case ReportKind::StepFailed:
      if (parts_.calls.has(head.request))
        parts_.reports.verification().progress_failed(
            head.request, step_in(payload), parts_.reports.notice_of(head.index, SaidFailure{payload}.reason()));
      break;
    case ReportKind::Finished: parts_.calls.completed(head.request); break;
    case ReportKind::Aborted:
      if (parts_.calls.has(head.request))
        parts_.calls.failed(head.request, parts_.reports.notice_of(head.index, SaidFailure{payload}.reason()));
      break;
    case ReportKind::StateEntered: parts_.states.cycle_entered(static_cast<State>(head.index)); break;
    case ReportKind::EntryRefused:
      if (parts_.states.awaits(static_cast<State>(head.index)))
        parts_.states.cycle_refused(static_cast<State>(head.index), SaidFailure{payload}.kept());
      break;
    case ReportKind::NodeFailed:
      parts_.states.node_failed(static_cast<State>(head.index), SaidFailure{payload}.kept());
      break;
    case ReportKind::InputDetached:
    case ReportKind::OutputDetached: parts_.links.let_go(head.link); break;
    case ReportKind::Reconfigured: parts_.bumpless.ended(static_cast<std::uint8_t>(head.index), std::nullopt); break;
    case ReportKind::NotReconfigured:
      parts_.bumpless.ended(static_cast<std::uint8_t>(head.index), SaidFailure{payload}.kept());
      break;
    case ReportKind::SelfTestEnded:
      parts_.self_tests.ended(head.request, head.index, SaidFailure{payload}.reason());
      break;
  }
}

}  // namespace hirosco
