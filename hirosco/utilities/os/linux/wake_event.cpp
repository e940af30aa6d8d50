// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>

#include "hirosco/utilities/os/wait_set.hpp"

namespace hirosco {

Result<WakeEvent> WakeEvent::create() noexcept {
  FileDescriptor event{::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
  if (!event) return fail(ErrorCode::SystemFailure, "eventfd", errno);
  return WakeEvent{std::move(event), FileDescriptor{}};
}

void WakeEvent::notify() noexcept {
  // A counter at its limit refuses, and is a notification already.
  const std::uint64_t one = 1;
  while (::write(read_end_.get(), &one, sizeof one) < 0 && errno == EINTR) {}
}

void WakeEvent::clear() noexcept {
  std::uint64_t sink = 0;
  while (::read(read_end_.get(), &sink, sizeof sink) < 0 && errno == EINTR) {}
}

}  // namespace hirosco
