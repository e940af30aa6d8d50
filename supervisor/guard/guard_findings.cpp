// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: fence (docs/safety/modules.csv).
#include "supervisor/guard/guard_findings.hpp"

#include <algorithm>

namespace hirosco::supervisor {
namespace {

/// Findings that nobody takes are those of a supervisor that stands still: the first tell the story, and beyond them each that was not told
/// yet, once.
constexpr std::size_t most_findings = 1024;

}  // namespace

void GuardFindings::reserve() { findings_.reserve(most_findings); }

void GuardFindings::find_out(GuardFinding::Kind kind, std::uint16_t apid, std::uint16_t device) {
  const GuardFinding found{kind, apid, device};
  if (findings_.size() < most_findings || std::ranges::find(findings_, found) == findings_.end())
    findings_.push_back(found);
  wake();
}

void GuardFindings::wake() const {
  if (on_finding_) on_finding_();
}

std::vector<GuardFinding> GuardFindings::take() {
  std::vector<GuardFinding> taken{findings_};
  findings_.clear();
  return taken;
}

void GuardFindings::forget_end_of(std::uint16_t apid) {
  std::erase_if(findings_, [&](const GuardFinding& finding) {
    return finding.apid == apid && finding.kind == GuardFinding::Kind::Ended;
  });
}

}  // namespace hirosco::supervisor
