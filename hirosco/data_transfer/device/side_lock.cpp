// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/side_lock.hpp"

#include <fcntl.h>
#include <time.h>
#include <unistd.h>

namespace hirosco {
namespace {

constexpr int closing_attempts = 200;

struct flock one(std::size_t octet, short type) noexcept {
  struct flock range{};
  range.l_type = type;
  range.l_whence = SEEK_SET;
  range.l_start = static_cast<off_t>(octet);
  range.l_len = 1;
  return range;
}

}  // namespace

bool lock_side(int file, std::size_t octet) noexcept {
  struct flock range = one(octet, F_WRLCK);
  return ::fcntl(file, F_OFD_SETLK, &range) == 0;
}

void free_side(int file, std::size_t octet) noexcept {
  struct flock range = one(octet, F_UNLCK);
  (void)::fcntl(file, F_OFD_SETLK, &range);
}

bool is_locked_by_another(int file, std::size_t octet) noexcept {
  struct flock range = one(octet, F_WRLCK);
  return ::fcntl(file, F_OFD_GETLK, &range) == 0 && range.l_type != F_UNLCK;
}

void pause_for_peer() noexcept {
  const timespec moment{0, 100'000};
  (void)::nanosleep(&moment, nullptr);
}

bool take_turn_to_close(int file, std::size_t octet) noexcept {
  for (int i = 0; i < closing_attempts; ++i) {
    if (lock_side(file, octet)) return true;
    pause_for_peer();
  }
  return false;
}

}  // namespace hirosco
