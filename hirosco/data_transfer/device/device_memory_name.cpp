// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/device_memory_name.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace hirosco {
namespace {

[[nodiscard]] std::string name_of(std::string address) {
  std::ranges::replace(address, '/', '.');
  return address;
}

/// Not as the mask of who comes first has it.
[[nodiscard]] Result<> make_open_folder(const std::string& place) {
  namespace fs = std::filesystem;
  std::error_code refused, failed;
  if (fs::create_directory(place, refused)) {
    fs::permissions(place, fs::perms::all | fs::perms::sticky_bit, failed);
    return ok();
  }
  const fs::file_type there = fs::symlink_status(place, failed).type();
  if (there == fs::file_type::directory) return ok();
  if (there == fs::file_type::not_found)
    return fail(ErrorCode::SystemFailure, "make the folder of its frames in shared memory", refused.value());
  return fail(ErrorCode::Mismatch, "a file or link stands where the folder of its frames in shared memory is to be");
}

}  // namespace

std::string device_memory_folder(const std::string& address) {
  return std::string{device_memory_root} + "/" + name_of(address);
}

std::string device_memory_file(const std::string& address, FlowHolder holder) {
  if (holder == FlowHolder::Supervisor) return std::string{device_memory_root} + "." + name_of(address);
  return device_memory_folder(address) + "/frames";
}

Result<> make_device_memory_folder(const std::string& address) {
  // Those would be the folder of all, or the one that second inhibits are in.
  const std::string name = name_of(address);
  if (name.empty() || name == "." || name == "..") return fail(ErrorCode::InvalidArgument, "address of shared memory");
  HIROSCO_TRY(make_open_folder(device_memory_root));
  return make_open_folder(device_memory_folder(address));
}

void remove_device_memory_folder(const std::string& address) {
  namespace fs = std::filesystem;
  std::error_code failed;
  const std::string folder = device_memory_folder(address);
  if (fs::is_directory(fs::symlink_status(folder, failed))) fs::remove(folder, failed);
}

}  // namespace hirosco
