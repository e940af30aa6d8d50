// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/address/socket_address.hpp"

#include <gtest/gtest.h>
#include <netdb.h>

#include <array>
#include <string_view>

#include "hirosco/utilities/os/file_descriptor.hpp"

namespace hirosco {
namespace {

TEST(SocketAddresses, AreWhatTheSystemMakesOfTheSameWords) {
  for (const auto& [host, port, text] :
       {std::array{"192.0.2.7", "4000", "192.0.2.7:4000"}, std::array{"2001:db8::7", "4001", "[2001:db8::7]:4001"}}) {
    addrinfo wanted{};
    wanted.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV;
    wanted.ai_socktype = SOCK_DGRAM;
    addrinfo* found = nullptr;
    ASSERT_EQ(::getaddrinfo(host, port, &wanted, &found), 0) << text;
    const SocketAddress made = socket_address(read_internet_address(text).value());
    EXPECT_EQ(made.octets, found->ai_addrlen);
    EXPECT_EQ(std::string_view(reinterpret_cast<const char*>(made.get()), made.octets),
              std::string_view(reinterpret_cast<const char*>(found->ai_addr), found->ai_addrlen));
    ::freeaddrinfo(found);
  }
}

TEST(SocketAddresses, LoseNothingOnTheWayThereAndBack) {
  for (const char* text : {"192.0.2.7:4000", "127.0.0.1:1", "[2001:db8::7]:65535", "[::1]:80"}) {
    const InternetAddress address = read_internet_address(text).value();
    EXPECT_EQ(internet_address(socket_address(address)), address) << text;
  }
}

TEST(SocketAddresses, OfASocketHaveThePortThatItWasGiven) {
  const FileDescriptor socket{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  const SocketAddress any_port = socket_address(read_internet_address("127.0.0.1").value());
  ASSERT_EQ(::bind(socket.get(), any_port.get(), any_port.octets), 0);
  const auto own = own_internet_address(socket.get());
  ASSERT_TRUE(own);
  EXPECT_TRUE(own->loopback());
  EXPECT_NE(own->port, 0);
}

TEST(SocketAddresses, OfWhatIsNoInternetSocketThereAreNone) {
  const FileDescriptor local{::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  EXPECT_FALSE(own_internet_address(local.get()));
  EXPECT_FALSE(own_internet_address(-1));
}

}  // namespace
}  // namespace hirosco
