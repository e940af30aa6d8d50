// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/epoch_file.hpp"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <future>
#include <limits>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "hirosco/utilities/os/file_descriptor.hpp"

namespace hirosco::supervisor {
namespace {

/// Far more than the fences and releases of an ordinary flight; more are reserved as they are used. Flights that follow each other
/// faster than so many seconds use up numbers: 60,000 of them all.
constexpr std::uint32_t block = 65'536;
/// After a write that failed: so many more are used before the next.
constexpr std::uint32_t pause = 64;
/// A supervisor notes once in each step what is in use: its guard has used fewer than so many since.
constexpr std::uint64_t most_unnoted = 4096;
/// A number too close to the end is refused while somebody can still do something about it.
constexpr std::uint32_t last_first = std::numeric_limits<std::uint32_t>::max() - 1'000'000;
/// 2020-01-01 after 1958-01-01, the epoch of on-board time (TAI, without leap seconds).
constexpr std::int64_t year_2020_s = 1'956'528'000;

/// 0: there is none, or none that can be read.
[[nodiscard]] std::uint64_t read_file(const std::filesystem::path& path) {
  std::uint64_t kept = 0;
  std::ifstream{path} >> kept;
  return kept;
}

/// On the disk when this is true: file, name and folder.
[[nodiscard]] bool write(const std::filesystem::path& path, std::uint32_t reserved) {
  std::error_code failed;
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path{"."};
  std::filesystem::create_directories(folder, failed);
  auto beside = path;
  beside += ".new";
  {
    const FileDescriptor file{::open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)};
    const std::string text = std::to_string(reserved) + "\n";
    if (!file || ::write(file.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size()) ||
        ::fsync(file.get()) != 0)
      return false;
  }
  if (::rename(beside.c_str(), path.c_str()) != 0) return false;
  const FileDescriptor holds{::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  return holds && ::fsync(holds.get()) == 0;
}

}  // namespace

struct EpochFile::File {
  std::filesystem::path path;
  std::atomic<std::uint32_t> kept{0};
  std::atomic<bool> busy{false};
};

EpochFile::EpochFile(std::filesystem::path path) : file_{std::make_shared<File>()} { file_->path = std::move(path); }

const std::filesystem::path& EpochFile::path() const noexcept { return file_->path; }
std::uint32_t EpochFile::kept() const noexcept { return file_->kept.load(std::memory_order_acquire); }

std::uint64_t EpochFile::read_within(Duration patience) const {
  std::packaged_task<std::uint64_t()> task{[file = file_] { return read_file(file->path); }};
  std::future<std::uint64_t> read = task.get_future();
  try {
    std::thread{std::move(task)}.detach();
  } catch (const std::system_error&) {  // no thread is left
    return 0;
  }
  return read.wait_for(patience) == std::future_status::ready ? read.get() : 0;
}

Result<std::uint32_t> EpochFile::above(std::uint64_t kept, OnboardTime now, std::uint64_t used) const {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(now.time_since_epoch()).count() - year_2020_s;
  const std::uint64_t first =
      std::max({kept + 1, used + 1, static_cast<std::uint64_t>(std::max<std::int64_t>(seconds, 1))});
  if (first > last_first)
    return fail(ErrorCode::OutOfRange, "the epochs of devices have run out: reset the devices, then remove this file",
                static_cast<std::int64_t>(kept));
  return static_cast<std::uint32_t>(first);
}

Result<std::uint32_t> EpochFile::first(OnboardTime now) {
  HIROSCO_TRY_LET(const std::uint32_t number, above(read_file(path()), now));
  if (write(path(), number + block)) file_->kept = number + block;
  else next_try_ = number + pause;
  return number;
}

Result<std::uint32_t> EpochFile::next(OnboardTime now, std::uint32_t noted, Duration patience) {
  const std::uint64_t kept = noted != 0 ? read_within(patience) : read_file(path());
  HIROSCO_TRY_LET(const std::uint32_t number, above(kept, now, noted != 0 ? noted + most_unnoted : 0));
  next_try_ = number + pause;
  keep_in_a_thread(number + block);
  return number;
}

void EpochFile::keep_above(std::uint32_t used) {
  if (used + block / 2 <= kept() || used < next_try_) return;
  next_try_ = used + pause;
  keep_in_a_thread(used + block);
}

void EpochFile::keep_in_a_thread(std::uint32_t reserved) {
  if (file_->busy.exchange(true)) return;
  try {
    std::thread{[file = file_, reserved] {
      if (write(file->path, reserved)) file->kept.store(reserved, std::memory_order_release);
      file->busy = false;
    }}.detach();
  } catch (const std::system_error&) {  // no thread is left: later
    file_->busy = false;
  }
}

}  // namespace hirosco::supervisor
