// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/keeper/service_notice.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <string>

namespace hirosco::supervisor {
namespace {

/// A service manager: a socket of datagrams under a name of the abstract kind.
class Manager {
 public:
  explicit Manager(std::string name) : name_{std::move(name)} {
    sockaddr_un at{};
    at.sun_family = AF_UNIX;
    std::memcpy(at.sun_path + 1, name_.data() + 1, name_.size() - 1);
    const auto octets = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name_.size());
    EXPECT_EQ(::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&at), octets), 0);
  }
  [[nodiscard]] const char* address() const { return name_.c_str(); }
  /// Empty: nothing was told.
  [[nodiscard]] std::string told() const {
    std::array<char, 256> text;
    const auto octets = ::recv(socket_.get(), text.data(), text.size(), MSG_DONTWAIT);
    return {text.data(), static_cast<std::size_t>(std::max<ssize_t>(octets, 0))};
  }

 private:
  std::string name_;
  FileDescriptor socket_{::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
};

TEST(ServiceNotice, TellsTheManagerThatItIsReadyAndThatItEnds) {
  const Manager manager{"@hirosco-notice-" + std::to_string(::getpid())};
  const auto notice = ServiceNotice::open(manager.address());
  ASSERT_TRUE(notice);
  EXPECT_EQ(manager.told(), "") << "nothing before it is";
  notice->ready();
  EXPECT_TRUE(manager.told().starts_with("READY=1\n"));
  notice->ends();
  EXPECT_TRUE(manager.told().starts_with("STOPPING=1\n"));
}

TEST(ServiceNotice, TakesTheAddressOutOfTheEnvironment) {
  const Manager manager{"@hirosco-notice-taken-" + std::to_string(::getpid())};
  ::setenv("NOTIFY_SOCKET", manager.address(), 1);
  const ServiceNotice notice = ServiceNotice::take();
  EXPECT_EQ(::getenv("NOTIFY_SOCKET"), nullptr);
  notice.ready();
  EXPECT_NE(manager.told(), "");
}

TEST(ServiceNotice, WithoutAManagerNobodyIsTold) {
  ::unsetenv("NOTIFY_SOCKET");
  ServiceNotice::take().ready();
  EXPECT_TRUE(ServiceNotice::open(nullptr));
  EXPECT_TRUE(ServiceNotice::open(""));
  ::setenv("NOTIFY_SOCKET", "/nowhere/to/be/found", 1);
  ServiceNotice::take().ready();
}

TEST(ServiceNotice, RefusesWhatIsNoAddress) {
  EXPECT_EQ(ServiceNotice::open("relative").error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(ServiceNotice::open(("/" + std::string(200, 'x')).c_str()).error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(ServiceNotice::open("/nowhere/to/be/found").error().code, ErrorCode::Unavailable);
}

TEST(ServiceNotice, AManagerThatDoesNotListenHoldsUpNobody) {
  const Manager manager{"@hirosco-notice-full-" + std::to_string(::getpid())};
  const auto notice = ServiceNotice::open(manager.address());
  ASSERT_TRUE(notice);
  for (int i = 0; i < 100'000; ++i) notice->ready();  // more than any socket holds
  EXPECT_NE(manager.told(), "");
}

}  // namespace
}  // namespace hirosco::supervisor
