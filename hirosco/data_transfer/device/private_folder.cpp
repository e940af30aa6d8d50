// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/private_folder.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "hirosco/utilities/os/file_descriptor.hpp"

namespace hirosco {
namespace {

constexpr mode_t all_rights = 07777, of_two = 0770;

[[nodiscard]] bool is_of_two(const struct stat& folder) noexcept {
  return S_ISDIR(folder.st_mode) && (folder.st_mode & all_rights) == of_two;
}

}  // namespace

bool is_private_folder(const std::string& folder, std::uint32_t group) noexcept {
  struct stat found{};
  return ::lstat(folder.c_str(), &found) == 0 && is_of_two(found) && found.st_uid == ::geteuid() &&
         found.st_gid == group;
}

Result<> make_private(const std::string& folder, std::uint32_t group) noexcept {
  // Not by its name, behind which another one may stand the next time.
  const FileDescriptor opened{::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)};
  struct stat found{};
  if (!opened && (errno == ENOTDIR || errno == ELOOP)) return fail(ErrorCode::Mismatch, "it is no folder");
  if (!opened || ::fstat(opened.get(), &found) != 0) return fail(ErrorCode::SystemFailure, "open it", errno);
  if (found.st_uid != ::geteuid()) return fail(ErrorCode::Mismatch, "it belongs to another user", found.st_uid);
  // Shut first: between the two nobody is let in who was not, and the group of before no more.
  if (::fchmod(opened.get(), S_IRWXU) != 0 || ::fchown(opened.get(), static_cast<uid_t>(-1), group) != 0 ||
      ::fchmod(opened.get(), of_two) != 0)
    return fail(ErrorCode::SystemFailure, "give it to its subsystem", errno);
  return ok();
}

Result<> make_private_folder(const std::string& folder, std::uint32_t group, const GroupRange& others) noexcept {
  if (is_private_folder(folder, group)) return ok();
  if (::mkdir(folder.c_str(), S_IRWXU) == 0) return make_private(folder, group);
  if (errno != EEXIST) return fail(ErrorCode::SystemFailure, "make it", errno);
  struct stat found{};
  if (::lstat(folder.c_str(), &found) != 0 || !is_of_two(found) || !others.contains(found.st_gid))
    return fail(ErrorCode::Mismatch, "it is there, and open to others than its subsystem");
  return make_private(folder, group);
}

std::string socket_at(const std::string& path) {
  struct stat found{};
  return ::lstat(path.c_str(), &found) == 0 && is_of_two(found) ? path + "/socket" : path;
}

OpenInPrivate::OpenInPrivate(const std::string& file) noexcept {
  const auto slash = file.rfind('/');
  struct stat folder{};
  const int looked =
      slash == std::string::npos ? ::stat(".", &folder) : ::stat(file.substr(0, slash + 1).c_str(), &folder);
  private_ = looked == 0 && is_of_two(folder);
  if (private_) before_ = ::umask(0);
}

}  // namespace hirosco
