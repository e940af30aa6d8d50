// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/exchanged_names.hpp"

namespace hirosco {

Result<> exchange_names(const std::string& /*one*/, const std::string& /*other*/) noexcept {
  return fail(ErrorCode::Unavailable, "POSIX exchanges no names");
}

}  // namespace hirosco
