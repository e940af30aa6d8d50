// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/keeper/service_notice.hpp"

#include <sys/socket.h>
#include <sys/un.h>

#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>

namespace hirosco::supervisor {

Result<ServiceNotice> ServiceNotice::open(const char* address) noexcept {
  ServiceNotice notice;
  if (address == nullptr || *address == '\0') return notice;
  const std::string_view name{address};
  sockaddr_un to{};
  to.sun_family = AF_UNIX;
  if ((name[0] != '/' && name[0] != '@') || name.size() >= sizeof to.sun_path)
    return fail(ErrorCode::InvalidArgument, "address of a service manager");
  std::memcpy(to.sun_path, name.data(), name.size());
  if (name[0] == '@') to.sun_path[0] = '\0';
  FileDescriptor manager{::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)};
  if (!manager) return fail(ErrorCode::SystemFailure, "socket to the service manager", errno);
  const auto octets = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
  if (::connect(manager.get(), reinterpret_cast<const sockaddr*>(&to), octets) != 0)
    return fail(ErrorCode::Unavailable, "service manager", errno);
  notice.manager_ = std::move(manager);
  return notice;
}

ServiceNotice ServiceNotice::take() noexcept {
  auto notice = open(std::getenv("NOTIFY_SOCKET"));
  ::unsetenv("NOTIFY_SOCKET");
  return notice ? std::move(*notice) : ServiceNotice{};
}

void ServiceNotice::tell(std::string_view lines) const noexcept {
  if (manager_) static_cast<void>(::send(manager_.get(), lines.data(), lines.size(), MSG_NOSIGNAL));
}

}  // namespace hirosco::supervisor
