// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/exchanged_folder.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <optional>
#include <system_error>

#include "hirosco/data_transfer/device/side_lock.hpp"
#include "hirosco/utilities/os/exchanged_names.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"

namespace hirosco {
namespace {

constexpr int attempts = 20;
constexpr mode_t all_rights = 07777;
constexpr const char* frames = "frames";

struct Node {
  dev_t device{};
  ino_t number{};
  friend bool operator==(const Node&, const Node&) = default;
};

[[nodiscard]] std::optional<Node> node_of(const std::string& file) noexcept {
  struct stat found{};
  if (::lstat(file.c_str(), &found) != 0) return std::nullopt;
  return Node{found.st_dev, found.st_ino};
}

[[nodiscard]] std::string frames_in(const std::string& folder) { return folder + "/" + frames; }

[[nodiscard]] Error refused_by_system(const char* what) noexcept {
  const bool foreign = errno == EPERM || errno == EACCES;
  return {foreign ? ErrorCode::NotPermitted : ErrorCode::SystemFailure, foreign ? "it belongs to another user" : what,
          errno};
}

/// Not by its name, behind which a link may stand the next time.
[[nodiscard]] Result<FileDescriptor> opened(const std::string& folder) noexcept {
  FileDescriptor found{::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)};
  if (found) return found;
  if (errno == ENOENT) return fail(ErrorCode::NotFound, "there is no such folder");
  if (errno == ENOTDIR || errno == ELOOP) return fail(ErrorCode::Mismatch, "it is no folder");
  return fail(refused_by_system("open a folder of frames"));
}

/// Shut in between: who was not let in is not while it becomes the other's.
[[nodiscard]] Result<> make_alike(const FileDescriptor& spare, const struct stat& place) noexcept {
  if (::fchmod(spare.get(), S_IRWXU) != 0 || ::fchown(spare.get(), static_cast<uid_t>(-1), place.st_gid) != 0 ||
      ::fchmod(spare.get(), place.st_mode & all_rights) != 0)
    return fail(refused_by_system("give a folder the rights of another"));
  return ok();
}

/// The frames of `place` have a second name in `spare`; where there are none, there none.
[[nodiscard]] Result<> link_frames(const FileDescriptor& spare, const FileDescriptor& place) noexcept {
  if (::unlinkat(spare.get(), frames, 0) != 0 && errno != ENOENT)
    return fail(ErrorCode::Mismatch, "the spare folder has something else in the place of frames", errno);
  if (::linkat(place.get(), frames, spare.get(), frames, 0) == 0 || errno == ENOENT) return ok();
  // What the process of the spare folder makes there in this moment is tried again, and then is its own.
  if (errno == EEXIST) return fail(ErrorCode::Unavailable, "its process puts frames into the spare folder");
  return fail(refused_by_system("give frames a second name"));
}

}  // namespace

Result<> exchange_memory_folder(const std::string& spare, const std::string& place) {
  HIROSCO_TRY_LET(const FileDescriptor spare_folder, opened(spare));
  Error last{ErrorCode::Unavailable, "its device opens and closes its frames all the time"};
  for (int i = 0; i < attempts; ++i) {
    HIROSCO_TRY_LET(const FileDescriptor before, opened(place));
    struct stat rights{};
    if (::fstat(before.get(), &rights) != 0) return fail(refused_by_system("look at a folder of frames"));
    HIROSCO_TRY(make_alike(spare_folder, rights));
    if (const auto linked = link_frames(spare_folder, before); !linked) {
      if (linked.error().code != ErrorCode::Unavailable) return fail(linked.error());
      last = linked.error();
      continue;
    }
    HIROSCO_TRY(exchange_names(spare, place));
    // Who opened them in between is on a file that the new folder does not have: back, and once more.
    const auto left = node_of(frames_in(spare));
    if (!left || left == node_of(frames_in(place))) {
      static_cast<void>(::unlinkat(before.get(), frames, 0));
      return ok();
    }
    HIROSCO_TRY(exchange_names(spare, place));
    pause_for_peer();
  }
  static_cast<void>(::unlinkat(spare_folder.get(), frames, 0));
  return fail(last);
}

bool is_open_by_a_subsystem(const std::string& place) noexcept {
  constexpr std::size_t side_of_subsystems = 0;
  const FileDescriptor file{::open(frames_in(place).c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW)};
  return file && is_locked_by_another(file.get(), side_of_subsystems);
}

bool holds_frames_at_most(const std::string& place) noexcept {
  namespace fs = std::filesystem;
  std::error_code failed;
  const fs::directory_iterator content{place, failed};
  return !failed &&
         std::ranges::all_of(content, [](const fs::directory_entry& each) { return each.path().filename() == frames; });
}

}  // namespace hirosco
