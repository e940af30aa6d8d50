// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "hirosco/utilities/result.hpp"

namespace hirosco {

/// What failed, in words that outlive whoever said them.
struct Failure {
  ErrorCode code{ErrorCode::Internal};
  std::string text;
  std::int64_t number{0};
};

}  // namespace hirosco
