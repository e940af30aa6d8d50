// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/file_descriptor.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

namespace hirosco {

void FileDescriptor::reset(int number) noexcept {
  const int old = std::exchange(number_, number);
  // After EINTR the descriptor is gone too; a second close could hit another thread's.
  if (old >= 0 && old != number) (void)::close(old);
}

Result<FileDescriptor> FileDescriptor::duplicate() const noexcept {
  const int copy = ::fcntl(number_, F_DUPFD_CLOEXEC, 0);
  if (copy < 0) return fail(ErrorCode::SystemFailure, "duplicate descriptor", errno);
  return FileDescriptor{copy};
}

}  // namespace hirosco
