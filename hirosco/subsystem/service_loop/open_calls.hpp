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

  /// Whether another one may run, beside those that do and those of which the cycle has not said whether they do.
  [[nodiscard]] bool have_room() const noexcept { return open_.size() + handed_over_ < most; }
  /// To the cycle, which says started or refused. Here, not by what is left in its ring: it may have taken one and not have said so yet.
  void handed_over() noexcept { ++handed_over_; }

  void started(const pus::Request& request) {
    answered();
    open_.push_back(request);
    verification_.started(request);
  }
  void refused(const pus::Request& request, const pus::FailureNotice& why) {
    answered();
    verification_.start_failed(request, why);
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

  /// The cycle rests, and all that it had said was taken.
  void forget_handed_over() noexcept { handed_over_ = 0; }

 private:
  void answered() noexcept {
    if (handed_over_ > 0) --handed_over_;
  }
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
  std::size_t handed_over_{0};
};

}  // namespace hirosco
