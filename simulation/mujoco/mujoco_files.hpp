// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include <mujoco/mujoco.h>

namespace hirosco::simulation {

/// Files that MuJoCo finds by name, without any that the computer has.  Realtime: allocates.
class MujocoFiles {
 public:
  explicit MujocoFiles(const std::map<std::string, std::string>& octets) {
    mj_defaultVFS(&vfs_);
    for (const auto& [name, content] : octets)
      mj_addBufferVFS(&vfs_, name.c_str(), content.data(), static_cast<int>(content.size()));
  }
  ~MujocoFiles() { mj_deleteVFS(&vfs_); }
  MujocoFiles(const MujocoFiles&) = delete;
  MujocoFiles& operator=(const MujocoFiles&) = delete;
  [[nodiscard]] const mjVFS* get() const noexcept { return &vfs_; }

 private:
  mjVFS vfs_{};
};

}  // namespace hirosco::simulation
