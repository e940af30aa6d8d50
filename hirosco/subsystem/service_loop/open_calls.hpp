// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "hirosco/pus/service/service.hpp"
#include "hirosco/pus/st01_verification/verification.hpp"

namespace hirosco {

/// Functions that were handed to the cycle: each gets exactly one final report.  Thread: the service loop.
class OpenCalls {
 public:
  /// So many run at once, at most: none takes from the heap then.
  static constexpr std::size_t most = 64;

  explicit OpenCalls(pus::Verification& verification) : verification_{verification} { open_.reserve(most); }

  /// Whether another one may run beside those that do and `handed_over`, which the cycle has not begun.
  [[nodiscard]] bool have_room(std::size_t handed_over) const noexcept { return open_.size() + handed_over < most; }

  void started(const pus::Request& request) {
    open_.push_back(request);
    verification_.started(request);
  }
  /// Nothing where it had its final report already.
  void completed(const pus::Request& request) {
    if (close(request)) verification_.completed(request);
  }
  [[nodiscard]] bool has(const pus::Request& request) const noexcept { return find(request) != open_.end(); }
  void failed(const pus::Request& request, const pus::FailureNotice& why) {
    if (close(request)) verification_.completion_failed(request, why);
  }
  void abort_all() {
    for (const pus::Request& open : open_)
      verification_.completion_failed(open, pus::FailureNotice{pus::FailureCode::Aborted});
    open_.clear();
  }

 private:
  [[nodiscard]] std::vector<pus::Request>::const_iterator find(const pus::Request& request) const noexcept {
    return std::ranges::find_if(
        open_, [&](const pus::Request& open) { return open.id == request.id && open.source == request.source; });
  }
  bool close(const pus::Request& request) {
    const auto found = find(request);
    if (found == open_.end()) return false;
    open_.erase(found);
    return true;
  }

  pus::Verification& verification_;
  std::vector<pus::Request> open_;
};

}  // namespace hirosco
