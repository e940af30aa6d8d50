// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "hirosco/pus/st17_test/self_test.hpp"

namespace hirosco::pus::testing {

/// Begins nothing: remembers who asked, or refuses.
struct PlayedSelfTest final : SelfTest {
  std::expected<void, FailureNotice> begin_self_test(const Request& request) override {
    if (refusal) return std::unexpected{*refusal};
    asked.push_back(request);
    return {};
  }
  [[nodiscard]] SelfTestRecord newest_self_test() const override { return newest; }

  std::optional<FailureNotice> refusal;
  std::vector<Request> asked;
  SelfTestRecord newest;
};

}  // namespace hirosco::pus::testing
