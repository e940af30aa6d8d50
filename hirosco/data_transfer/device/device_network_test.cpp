// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/device_network.hpp"

#include <gtest/gtest.h>

namespace hirosco {
namespace {

TEST(DeviceNetwork, IsReadAndSaidInOneForm) {
  for (const char* text : {"192.0.2.0/24", "10.0.0.0/8", "192.0.2.7/32", "192.0.2.128/25%eth1", "2001:db8::/64",
                           "2001:db8::7/128%can-gateway.0"}) {
    const auto network = read_device_network(text);
    ASSERT_TRUE(network) << text << ": " << network.error().text;
    EXPECT_EQ(to_text(*network), text);
  }
}

TEST(DeviceNetwork, RefusesWhatIsNoneOrIsToPermitTooMuch) {
  for (const char* text : {"",
                           "192.0.2.0",
                           "192.0.2.0/",
                           "192.0.2.0/x",
                           "192.0.2.0/33",
                           "192.0.2.0/-1",
                           "0.0.0.0/0",
                           "16.0.0.0/7",
                           "192.0.2.1/24",
                           "192.0.2.0/24%",
                           "192.0.2.0/24%eth 1",
                           "192.0.2.0/24%a-name-that-is-too-long",
                           "192.0.2.0:5/24",
                           "127.0.0.0/8",
                           "127.1.0.0/16",
                           "::1/128",
                           "fe80::/10",
                           "224.0.0.0/8",
                           "2001:db8::/129",
                           "2001:db8::1/64",
                           "example.org/24",
                           "192.0.2.0/24/3"})
    EXPECT_FALSE(read_device_network(text)) << text;
}

TEST(DeviceNetwork, HasTheAddressesOfItsPrefixAndNoOthers) {
  const auto holds = [](const char* network, const char* address) {
    return read_device_network(network).value().contains(read_internet_address(address).value());
  };
  EXPECT_TRUE(holds("192.0.2.0/24", "192.0.2.255"));
  EXPECT_FALSE(holds("192.0.2.0/24", "192.0.3.0"));
  EXPECT_TRUE(holds("192.0.2.128/25", "192.0.2.128"));
  EXPECT_FALSE(holds("192.0.2.128/25", "192.0.2.127"));
  EXPECT_TRUE(holds("192.0.2.4/31", "192.0.2.5"));
  EXPECT_FALSE(holds("192.0.2.4/31", "192.0.2.6"));
  EXPECT_TRUE(holds("192.0.2.7/32", "192.0.2.7:4000"));
  EXPECT_TRUE(holds("2001:db8::/63", "2001:db8:0:1::9"));
  EXPECT_FALSE(holds("2001:db8::/64", "2001:db8:0:1::9"));
  EXPECT_FALSE(holds("32.1.13.0/24", "2001:d00::")) << "the same octets of another family";
}

TEST(DeviceNetwork, SeveralAreWordsAndWhatIsNoneOfThemPermitsNothing) {
  const auto networks = read_device_networks("192.0.2.0/24%eth1 nonsense 2001:db8::/64  10.1.0.0/16");
  EXPECT_EQ(words_of(networks), "192.0.2.0/24%eth1 2001:db8::/64 10.1.0.0/16");
  EXPECT_EQ(find_network(networks, read_internet_address("10.1.255.1").value()), &networks[2]);
  EXPECT_EQ(find_network(networks, read_internet_address("10.2.0.1").value()), nullptr);
  EXPECT_TRUE(read_device_networks("").empty());
}

TEST(DeviceAddress, IsALiteralWithAPort) {
  EXPECT_EQ(to_text(read_device_address("localhost:5000").value()), "127.0.0.1:5000");
  EXPECT_EQ(to_text(read_device_address("[2001:db8::7]:5000").value()), "[2001:db8::7]:5000");
  for (const char* text : {"192.0.2.1", "localhost", "arm.example.org:5000", "0.0.0.0:1", ""})
    EXPECT_FALSE(read_device_address(text)) << text;
}

}  // namespace
}  // namespace hirosco
