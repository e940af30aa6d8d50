// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "hirosco/utilities/os/wait_set.hpp"

namespace hirosco {

Result<WakeEvent> WakeEvent::create() noexcept {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) return fail(ErrorCode::SystemFailure, "wake pipe", errno);
  FileDescriptor read_end{ends[0]};
  FileDescriptor write_end{ends[1]};
  for (const int end : ends)
    if (::fcntl(end, F_SETFD, FD_CLOEXEC) != 0 || ::fcntl(end, F_SETFL, O_NONBLOCK) != 0)
      return fail(ErrorCode::SystemFailure, "wake pipe", errno);
  return WakeEvent{std::move(read_end), std::move(write_end)};
}

void WakeEvent::notify() noexcept {
  // A full pipe is a notification already.
  const char one = 1;
  while (::write(write_end_.get(), &one, 1) < 0 && errno == EINTR) {}
}

void WakeEvent::clear() noexcept {
  std::array<char, 256> sink{};
  ssize_t got = 0;
  do {
    got = ::read(read_end_.get(), sink.data(), sink.size());
  } while (got == static_cast<ssize_t>(sink.size()) || (got < 0 && errno == EINTR));
}

}  // namespace hirosco
