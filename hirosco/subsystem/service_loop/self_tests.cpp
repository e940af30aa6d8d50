// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/self_tests.hpp"

#include <array>

#include "hirosco/pus/st17_test/test_service.hpp"

namespace hirosco {

using pus::SelfTestOutcome;

void SelfTests::begun(const pus::Request& request) {
  verification_.started(request);
  asked_ = request;
  newest_ = {.outcome = SelfTestOutcome::Running, .configuration = newest_.configuration, .at = clock_.onboard()};
}

void SelfTests::ended(const pus::Request& request, std::uint16_t code, const pus::Reason& why) {
  // One that was given up with its configuration had its end.
  if (!asked_ || asked_->id != request.id || asked_->source != request.source) return;
  asked_.reset();
  newest_.at = clock_.onboard();
  newest_.outcome = code == 0 ? SelfTestOutcome::Passed : SelfTestOutcome::Failed;
  if (code != 0) {
    newest_.code = static_cast<pus::FailureCode>(code);
    newest_.number = why.number;
    newest_.reason = why.text;
  }
  std::array<std::byte, pus::max_self_test_octets> room;
  sink_.report(pus::TestService::service_type, pus::TestService::self_test_report, request.source,
               pus::write_self_test(room, newest_));
  if (code == 0) return verification_.completed(request);
  pus::FailureNotice notice{newest_.code};
  verification_.completion_failed(request, notice.because(why));
}

void SelfTests::applied(std::uint8_t configuration) { newest_ = {.configuration = configuration}; }

void SelfTests::abandon() {
  if (!asked_) return;
  const pus::Request request = *asked_;
  ended(request, static_cast<std::uint16_t>(pus::FailureCode::Aborted),
        {ErrorCode::Unavailable, 0, "self test: the configuration was given back"});
}

pus::SelfTestRecord SelfTests::record(bool passed) const {
  pus::SelfTestRecord known = newest_;
  if (known.outcome == SelfTestOutcome::Passed && !passed) known.outcome = SelfTestOutcome::Void;
  return known;
}

std::optional<pus::FailureNotice> SelfTests::keeps_from_operational(const descriptor::Configuration& configuration,
                                                                    bool passed) const {
  // What would be put out is just being tried.
  if (running()) return pus::FailureNotice{pus::FailureCode::Busy};
  if (configuration.self_test != descriptor::SelfTest::Required || passed) return std::nullopt;
  pus::FailureNotice notice{pus::FailureCode::SelfTestNotPassed};
  switch (record(passed).outcome) {
    case SelfTestOutcome::Failed:
      return notice.because({ErrorCode::NotPermitted, newest_.number, newest_.reason.view()});
    case SelfTestOutcome::Void:
      return notice.because({ErrorCode::NotPermitted, 0, "it passed before a device was lost: run SELF_TEST again"});
    default: return notice.because({ErrorCode::NotPermitted, 0, "it has not run in this configuration: run SELF_TEST"});
  }
}

}  // namespace hirosco
