// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/result.hpp"

namespace hirosco::supervisor {

/// How the service manager that started this process hears how it does: the datagrams of sd_notify(3). Where none did, nobody is told.
/// Thread: one. Realtime: never blocks, allocates nothing.
class ServiceNotice {
 public:
  /// `address` of the manager's socket, "/path" or "@name" (of the abstract kind); null or empty: there is no manager.
  [[nodiscard]] static Result<ServiceNotice> open(const char* address) noexcept;
  /// By NOTIFY_SOCKET, which is taken out of the environment: nothing that is started later speaks for this process. A socket
  /// that is not there is none.
  [[nodiscard]] static ServiceNotice take() noexcept;

  /// What systemd calls READY=1, with a status in words.
  void ready() const noexcept { tell("READY=1\nSTATUS=commissioned\n"); }
  void ends() const noexcept { tell("STOPPING=1\nSTATUS=going down in order\n"); }

 private:
  void tell(std::string_view lines) const noexcept;
  FileDescriptor manager_;
};

}  // namespace hirosco::supervisor
