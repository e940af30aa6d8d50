// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <string_view>

namespace hirosco::testing {

/// Whether a test that is SLICED (hirosco_test()) tries all that it could: NAME_whole, which is `long`. Otherwise it tries a part that
/// has something of each kind.
[[nodiscard]] inline bool whole() noexcept {
  const char* slice = std::getenv("HIROSCO_SLICE");
  return slice != nullptr && std::string_view{slice} == "whole";
}

/// Of so many one is tried: `slice` of them, or 1 in NAME_whole. One that shares no factor with how the kinds of what is tried
/// recur meets all of them.
template <class Integer>
[[nodiscard]] Integer one_in(Integer slice) noexcept {
  return whole() ? Integer{1} : slice;
}

}  // namespace hirosco::testing
