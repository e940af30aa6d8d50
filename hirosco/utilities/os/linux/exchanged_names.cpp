// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/exchanged_names.hpp"

#include <fcntl.h>

#include <cerrno>
#include <cstdio>

namespace hirosco {

Result<> exchange_names(const std::string& one, const std::string& other) noexcept {
  if (::renameat2(AT_FDCWD, one.c_str(), AT_FDCWD, other.c_str(), RENAME_EXCHANGE) == 0) return ok();
  if (errno == EPERM || errno == EACCES) return fail(ErrorCode::NotPermitted, "it belongs to another user", errno);
  return fail(ErrorCode::SystemFailure, "put one name in the place of another", errno);
}

}  // namespace hirosco
