// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/private_memory_folder.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "hirosco/data_transfer/device/device_memory_name.hpp"
#include "hirosco/data_transfer/device/private_folder.hpp"
#include "hirosco/data_transfer/device/side_lock.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"

namespace hirosco {

Result<> make_private_memory_folder(const std::string& address, std::uint32_t group) {
  const std::string folder = device_memory_folder(address);
  if (is_private_folder(folder, group)) return ok();
  HIROSCO_TRY(make_device_memory_folder(address));
  // By their rights of before they may be open to others than these two, or to one of them only.
  const std::string frames = device_memory_file(address, FlowHolder::Subsystem);
  const FileDescriptor file{::open(frames.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW)};
  if (!file && errno != ENOENT) return fail(ErrorCode::SystemFailure, "look at frames of before", errno);
  for (const std::size_t side : {0U, 1U})
    if (file && is_locked_by_another(file.get(), side))
      return fail(ErrorCode::Mismatch, "somebody has its frames open from when it was no user's own");
  if (file && ::unlink(frames.c_str()) != 0) return fail(ErrorCode::SystemFailure, "remove frames of before", errno);
  const auto made = make_private(folder, group);
  // What a flight of another user has left; nobody is in it.
  if (made || made.error().code != ErrorCode::Mismatch || ::rmdir(folder.c_str()) != 0) return made;
  HIROSCO_TRY(make_device_memory_folder(address));
  return make_private(folder, group);
}

}  // namespace hirosco
