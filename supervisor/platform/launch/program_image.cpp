// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/program_image.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <memory>

#include "hirosco/utilities/os/shared_memory.hpp"
#include "supervisor/platform/launch/sha256.hpp"

namespace hirosco::supervisor {
namespace {

constexpr unsigned executable_memory = 0x0010U;  // MFD_EXEC: asked for since Linux 6.3, unknown before

[[nodiscard]] FileDescriptor make_memory(const std::string& name) noexcept {
  const int made = ::memfd_create(name.c_str(), MFD_CLOEXEC | MFD_ALLOW_SEALING | executable_memory);
  if (made >= 0 || errno != EINVAL) return FileDescriptor{made};
  return FileDescriptor{::memfd_create(name.c_str(), MFD_CLOEXEC | MFD_ALLOW_SEALING)};
}

[[nodiscard]] bool write_all(int memory, const std::byte* octets, std::size_t count) noexcept {
  while (count > 0) {
    const auto written = ::write(memory, octets, count);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    octets += written;
    count -= static_cast<std::size_t>(written);
  }
  return true;
}

/// How many octets there were.
[[nodiscard]] Result<std::size_t> copy(int file, int memory) {
  constexpr std::size_t part_octets = std::size_t{1} << 20;
  const auto part = std::make_unique<std::byte[]>(part_octets);
  for (std::size_t all = 0;;) {
    const auto got = ::read(file, part.get(), part_octets);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return fail(ErrorCode::SystemFailure, "an executable cannot be read to its end", errno);
    if (got == 0) return all;
    all += static_cast<std::size_t>(got);
    if (all > ProgramImage::max_octets)
      return fail(ErrorCode::ResourceExhausted, "an executable is larger than 256 MiB");
    if (!write_all(memory, part.get(), static_cast<std::size_t>(got)))
      return fail(ErrorCode::ResourceExhausted, "no memory for an executable", errno);
  }
}

}  // namespace

Result<ProgramImage> ProgramImage::read(const std::filesystem::path& file) {
  // Not waited for where it is a pipe.
  const FileDescriptor opened{::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  if (!opened)
    return errno == ENOENT ? fail(ErrorCode::NotFound, "no such file")
                           : fail(ErrorCode::NotPermitted, "an executable may not be read", errno);
  struct stat status{};
  if (::fstat(opened.get(), &status) != 0)
    return fail(ErrorCode::SystemFailure, "an executable cannot be looked at", errno);
  if (!S_ISREG(status.st_mode)) return fail(ErrorCode::InvalidArgument, "an executable is no regular file");
  // Memory could be executed whatever its file says.
  if ((status.st_mode & (S_IXUSR | S_IXGRP | S_IXOTH)) == 0)
    return fail(ErrorCode::NotPermitted, "it may not be executed: its permissions forbid it");
  ProgramImage image;
  image.file_ = file;
  image.memory_ = make_memory(file.filename().string());
  if (!image.memory_) return fail(ErrorCode::SystemFailure, "no memory that may be executed", errno);
  HIROSCO_TRY_LET(image.octets_, copy(opened.get(), image.memory_.get()));
  if (image.octets_ == 0) return fail(ErrorCode::InvalidArgument, "an executable is empty");
  // First sealed, then hashed: from here on nobody changes it, who has this descriptor neither.
  if (::fcntl(image.memory_.get(), F_ADD_SEALS, F_SEAL_WRITE | F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0)
    return fail(ErrorCode::SystemFailure, "memory cannot be sealed", errno);
  HIROSCO_TRY_LET(const auto mapped, MappedMemory::map(image.memory_.get(), image.octets_, MapMode::ReadOnly));
  const Octets octets{mapped.octets()};
  image.digest_ = sha256(octets);
  image.interpreter_ = interpreter_of({reinterpret_cast<const char*>(octets.data()), octets.size()}, {});
  return image;
}

}  // namespace hirosco::supervisor
