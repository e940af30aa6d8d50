// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/address/internet_address.hpp"

#include <gtest/gtest.h>

namespace hirosco {
namespace {

TEST(InternetAddresses, AreLiteralsWithOrWithoutAPort) {
  for (const char* text : {"127.0.0.1", "192.0.2.7:4000", "2001:db8::7", "[2001:db8::7]:4000", "::1", "[::1]:65535"})
    EXPECT_EQ(to_text(read_internet_address(text).value()), text);
  EXPECT_EQ(read_internet_address("192.0.2.7:4000").value().port, 4000);
  EXPECT_EQ(read_internet_address("192.0.2.7").value().port, 0);
  EXPECT_EQ(to_text(read_internet_address("2001:DB8:0:0::7").value()), "2001:db8::7");
}

TEST(InternetAddresses, AreRefusedWhereTheyAreOfNoEndAlone) {
  for (const char* text : {"",
                           ":",
                           "localhost",
                           "example.org:4000",
                           "127.0.0.1:",
                           "127.0.0.1:0",
                           "127.0.0.1:65536",
                           "127.0.0.1: 80",
                           "127.0.0.1:80x",
                           "127.0.0",
                           "0127.0.0.1",
                           "[127.0.0.1]:80",
                           "[::1]",
                           "[::1]:",
                           "[::1]80",
                           "::1]:80",
                           "0.0.0.0",
                           "224.0.0.1",
                           "255.255.255.255",
                           "::",
                           "ff02::1",
                           "fe80::1",
                           "::ffff:127.0.0.1",
                           "127.0.0.1:1:2"})
    EXPECT_FALSE(read_internet_address(text)) << text;
  EXPECT_FALSE(read_internet_address(std::string_view{"127.0.0.1\0x", 11}));
}

TEST(InternetAddresses, SayWhetherTheyLeaveThisComputer) {
  for (const char* text : {"127.0.0.1", "127.1.2.3:9", "::1"}) EXPECT_TRUE(read_internet_address(text)->loopback());
  for (const char* text : {"192.0.2.7", "2001:db8::1", "100::1"}) EXPECT_FALSE(read_internet_address(text)->loopback());
  EXPECT_TRUE(read_internet_address("127.0.0.1:7")->same_host(*read_internet_address("127.0.0.1")));
  EXPECT_FALSE(read_internet_address("127.0.0.2")->same_host(*read_internet_address("127.0.0.1")));
}

}  // namespace
}  // namespace hirosco
