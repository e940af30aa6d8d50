// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <string>
#include <utility>

namespace hirosco::ground {

/// Why a request was not done, as an HTTP status.
struct Refusal {
  unsigned status{400};
  std::string text;
};
template <class T>
using Answered = std::expected<T, Refusal>;

[[nodiscard]] inline std::unexpected<Refusal> refuse(unsigned status, std::string text) {
  return std::unexpected{Refusal{status, std::move(text)}};
}

}  // namespace hirosco::ground
