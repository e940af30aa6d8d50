// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/stat.h>

#include <cstdint>
#include <string>

#include "hirosco/data_transfer/device/own_flow_access.hpp"
#include "hirosco/utilities/result.hpp"

/// Folders of the devices of a subsystem that is a user of its own (docs/adr/0177): of mode 0770, whoever flies and the subsystem's group get
/// in and nobody else. So what is in it is open to all: all are these two, and either may make it.
namespace hirosco {

/// Ours and that group's, and no link to one.  Realtime: blocks.
[[nodiscard]] bool is_private_folder(const std::string& folder, std::uint32_t group) noexcept;
/// Makes a folder of ours that is there one of us and that group. Mismatch: it is no folder, or of the user in `value`; SystemFailure: the
/// system refuses it.  Realtime: blocks.
[[nodiscard]] Result<> make_private(const std::string& folder, std::uint32_t group) noexcept;
/// Makes the folder, whose own one is there. One that is there is taken where it is private already, of that group or of one of `others`.
/// Mismatch: it is not; else as above.  Realtime: blocks.
[[nodiscard]] Result<> make_private_folder(const std::string& folder, std::uint32_t group,
                                           const GroupRange& others) noexcept;

/// Where the socket of a device is that is reached at this path: `socket` in it where that is a private folder, else itself.  Realtime: blocks.
[[nodiscard]] std::string socket_at(const std::string& path);

/// While it lives, what this process makes is as open as is asked for, whatever its mask, if `file` is in a private folder; else nothing is
/// different.  Realtime: blocks. Thread: one at a time in a process.
class OpenInPrivate {
 public:
  explicit OpenInPrivate(const std::string& file) noexcept;
  ~OpenInPrivate() {
    if (private_) ::umask(before_);
  }
  OpenInPrivate(const OpenInPrivate&) = delete;
  OpenInPrivate& operator=(const OpenInPrivate&) = delete;
  /// Of a file that only its user is to open: everybody who gets here where that is private.
  [[nodiscard]] mode_t mode() const noexcept { return private_ ? 0666 : 0600; }

 private:
  bool private_{false};
  mode_t before_{0};
};

}  // namespace hirosco
