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

}  // namespace hirosco::testing
