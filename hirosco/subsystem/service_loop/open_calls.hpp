// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "hirosco/pus/service/service.hpp"
#include "hirosco/pus/st01_verification/verification.hpp"

namespace hirosco {

/// Functions that run in the cycle: each gets exactly one final report.  Thread: the service loop.
class OpenCalls {
 public:
  /// `most` can be under way: none grows it then.
  OpenCalls(pus::Verification& verification, std::size_t most) : verification_{verification} { open_.reserve(most); }

  void started(const pus::Request& request) {
    open_.push_back(request);
    verification_.started(request);
  }
  /// Nothing where it had its final report already.
  void completed(const pus::Request& request) {
    if (close(request)) verification_.completed(request);
  }
  void failed(const pus::Request& request, const pus::FailureNotice& why) {
    if (close(request)) verification_.completion_failed(request, why);
  }
  void abort_all() {
    for (const pus::Request& open : open_)
      verification_.completion_failed(open, pus::FailureNotice{pus::FailureCode::Aborted});
    open_.clear();
  }

 private:
  bool close(const pus::Request& request) {
    const auto found = std::ranges::find_if(
        open_, [&](const pus::Request& open) { return open.id == request.id && open.source == request.source; });
    if (found == open_.end()) return false;
    open_.erase(found);
    return true;
  }

  pus::Verification& verification_;
  std::vector<pus::Request> open_;
};

}  // namespace hirosco
