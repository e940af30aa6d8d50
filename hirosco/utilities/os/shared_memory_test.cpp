// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/shared_memory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

namespace hirosco {
namespace {

[[nodiscard]] std::string new_name() { return "/hirosco-test-" + std::to_string(std::random_device{}()); }

TEST(SharedMemory, IsTheSameMemoryUnderItsName) {
  const std::string name = new_name();
  const auto made = SharedMemory::create(name.c_str(), 5000);
  ASSERT_TRUE(made) << made.error().text;
  ASSERT_EQ(made->octets().size(), 5000U);
  EXPECT_TRUE(std::ranges::all_of(made->octets(), [](std::byte b) { return b == std::byte{0}; }));
  const auto opened = SharedMemory::open(name.c_str(), 5000, MapMode::ReadOnly);
  ASSERT_TRUE(opened) << opened.error().text;
  EXPECT_NE(opened->octets().data(), made->octets().data());
  made->octets()[4999] = std::byte{0x5A};
  EXPECT_EQ(opened->octets()[4999], std::byte{0x5A});
  EXPECT_TRUE(SharedMemory::unlink(name.c_str()));
}

TEST(SharedMemory, NamesAreUniqueAndGoneAfterUnlink) {
  const std::string name = new_name();
  {
    const auto made = SharedMemory::create(name.c_str(), 100);
    ASSERT_TRUE(made);
    EXPECT_EQ(SharedMemory::create(name.c_str(), 100).error().code, ErrorCode::AlreadyExists);
    EXPECT_TRUE(SharedMemory::unlink(name.c_str()));
    made->octets()[0] = std::byte{1};
  }
  EXPECT_EQ(SharedMemory::open(name.c_str(), 100, MapMode::ReadWrite).error().code, ErrorCode::NotFound);
  EXPECT_EQ(SharedMemory::unlink(name.c_str()).error().code, ErrorCode::NotFound);
}

TEST(SharedMemory, RefusesToMapMoreThanThereIs) {
  const std::string name = new_name();
  const auto made = SharedMemory::create(name.c_str(), 4096);
  ASSERT_TRUE(made);
  EXPECT_EQ(SharedMemory::open(name.c_str(), 4097, MapMode::ReadOnly).error().code, ErrorCode::Mismatch);
  EXPECT_TRUE(SharedMemory::unlink(name.c_str()));
  EXPECT_FALSE(SharedMemory::create(new_name().c_str(), 0));
  EXPECT_FALSE(SharedMemory::create(new_name().c_str(), ~std::size_t{0}));
}

TEST(SharedMemory, AnonymousMemoryIsReachedByItsDescriptor) {
  auto made = SharedMemory::create_anonymous("test", 8192);
  ASSERT_TRUE(made) << made.error().text;
  EXPECT_TRUE(std::ranges::all_of(made->octets(), [](std::byte b) { return b == std::byte{0}; }));
  auto copy = made->descriptor().duplicate();
  ASSERT_TRUE(copy);
  const auto second = SharedMemory::from_descriptor(std::move(*copy), 8192, MapMode::ReadWrite);
  ASSERT_TRUE(second);
  second->octets()[8191] = std::byte{7};
  EXPECT_EQ(made->octets()[8191], std::byte{7});
  const SharedMemory moved = std::move(*made);
  EXPECT_EQ(moved.octets()[8191], std::byte{7});
}

}  // namespace
}  // namespace hirosco
