// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/value_disk.hpp"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include <system_error>
#include <utility>

#include "hirosco/utilities/os/file_descriptor.hpp"

namespace hirosco::supervisor {
namespace {

[[nodiscard]] std::unexpected<Error> system_failure(const char* what) {
  return fail(errno == ENOENT ? ErrorCode::NotFound : ErrorCode::SystemFailure, what, errno);
}

[[nodiscard]] Result<> sync_path(const std::filesystem::path& path, int flags) {
  const FileDescriptor opened{::open(path.c_str(), flags | O_CLOEXEC)};
  if (!opened || ::fsync(opened.get()) != 0) return system_failure("stored values cannot be synchronised");
  return ok();
}

}  // namespace

Result<std::vector<std::byte>> SystemValueDisk::read(const Path& file, std::size_t most) {
  // Who waits for the writer of a pipe would wait for ever.
  const FileDescriptor opened{::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  if (!opened) return system_failure("stored values cannot be opened");
  std::vector<std::byte> octets(most + 1);
  std::size_t used = 0;
  while (used < octets.size()) {
    const ssize_t got = ::read(opened.get(), octets.data() + used, octets.size() - used);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return system_failure("stored values cannot be read");
    if (got == 0) break;
    used += static_cast<std::size_t>(got);
  }
  if (used > most) return fail(ErrorCode::OutOfRange, "stored values are too long");
  octets.resize(used);
  return octets;
}

Result<> SystemValueDisk::create(const Path& file, Octets octets) {
  std::error_code failed;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), failed);
  const FileDescriptor opened{::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)};
  if (!opened) return system_failure("stored values cannot be created");
  while (!octets.empty()) {
    const ssize_t put = ::write(opened.get(), octets.data(), octets.size());
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return system_failure("stored values cannot be written");
    octets = octets.subspan(static_cast<std::size_t>(put));
  }
  return ok();
}

Result<> SystemValueDisk::sync(const Path& file) { return sync_path(file, O_RDONLY); }

Result<> SystemValueDisk::rename(const Path& from, const Path& to) {
  if (::rename(from.c_str(), to.c_str()) != 0) return system_failure("stored values cannot be renamed");
  return ok();
}

Result<> SystemValueDisk::sync_folder(const Path& folder) {
  return sync_path(folder.empty() ? Path{"."} : folder, O_RDONLY | O_DIRECTORY);
}

Result<std::vector<std::byte>> MemoryValueDisk::read(const Path& file, std::size_t most) {
  const auto found = files_.find(file);
  if (found == files_.end()) return fail(ErrorCode::NotFound, "no such file");
  if (found->second.size() > most) return fail(ErrorCode::OutOfRange, "stored values are too long");
  return found->second;
}

Result<> MemoryValueDisk::create(const Path& file, Octets octets) {
  files_[file].assign(octets.begin(), octets.end());
  return ok();
}

Result<> MemoryValueDisk::rename(const Path& from, const Path& to) {
  auto node = files_.extract(from);
  if (node.empty()) return fail(ErrorCode::NotFound, "no such file");
  files_.insert_or_assign(to, std::move(node.mapped()));
  return ok();
}

}  // namespace hirosco::supervisor
