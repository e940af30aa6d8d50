// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/epoch_file.hpp"

#include <algorithm>
#include <fstream>
#include <limits>

namespace hirosco::supervisor {
namespace {

/// Fences and releases of an ordinary flight; more are reserved as they are used.
constexpr std::uint32_t block = 4096;
/// A number too close to the end is refused while somebody can still do something about it.
constexpr std::uint32_t last_first = std::numeric_limits<std::uint32_t>::max() - 1'000'000;
/// 2020-01-01 after 1958-01-01, the epoch of on-board time (TAI, without leap seconds).
constexpr std::int64_t year_2020_s = 1'956'528'000;

}  // namespace

Result<std::uint32_t> EpochFile::first(OnboardTime now) {
  std::uint64_t kept = 0;
  std::ifstream{path_} >> kept;
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(now.time_since_epoch()).count() - year_2020_s;
  const std::uint64_t first = std::max({kept + 1, static_cast<std::uint64_t>(std::max<std::int64_t>(seconds, 1))});
  if (first > last_first)
    return fail(ErrorCode::OutOfRange, "the epochs of devices have run out: reset the devices, then remove this file",
                static_cast<std::int64_t>(kept));
  write(static_cast<std::uint32_t>(first) + block);
  return static_cast<std::uint32_t>(first);
}

void EpochFile::keep_above(std::uint32_t used) {
  if (used + block / 2 > reserved_) write(used + block);
}

void EpochFile::write(std::uint32_t reserved) {
  reserved_ = reserved;
  std::error_code failed;
  if (path_.has_parent_path()) std::filesystem::create_directories(path_.parent_path(), failed);
  auto beside = path_;
  beside += ".new";
  {
    std::ofstream file{beside, std::ios::trunc};
    file << reserved << '\n';
    if (!file.flush()) return;
  }
  std::filesystem::rename(beside, path_, failed);
}

}  // namespace hirosco::supervisor
