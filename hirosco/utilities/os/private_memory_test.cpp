// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/private_memory.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace hirosco {
namespace {

/// Whether these addresses are mapped: the system is asked, nothing is touched.
[[nodiscard]] bool is_mapped(MutableOctets octets) { return ::msync(octets.data(), octets.size(), MS_ASYNC) == 0; }

TEST(PrivateMemoryTest, IsZeroedWritableAndAtTheBeginningOfAPage) {
  const auto taken = PrivateMemory::take(100'000);
  ASSERT_TRUE(taken);
  const MutableOctets octets = taken->octets();
  ASSERT_EQ(octets.size(), 100'000U);
  EXPECT_TRUE(std::ranges::all_of(octets, [](std::byte octet) { return octet == std::byte{0}; }));
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(octets.data()) % static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE)), 0U);
  octets.back() = std::byte{1};
}

TEST(PrivateMemoryTest, IsGivenBackToTheSystemWithItsOwner) {
  MutableOctets where;
  {
    auto taken = PrivateMemory::take(1 << 20);
    ASSERT_TRUE(taken);
    where = taken->octets();
    const PrivateMemory moved = std::move(*taken);
    EXPECT_EQ(moved.octets().data(), where.data());
    EXPECT_TRUE(is_mapped(where));
  }
  EXPECT_FALSE(is_mapped(where));
}

TEST(PrivateMemoryTest, BeyondWhatThereIsIsRefusedWithTheNumber) {
  constexpr auto beyond_all_addresses = std::numeric_limits<std::size_t>::max() / 4;
  for (const std::size_t octets : {std::size_t{0}, beyond_all_addresses}) {
    const auto refused = PrivateMemory::take(octets);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::ResourceExhausted);
    EXPECT_EQ(refused.error().value, static_cast<std::int64_t>(octets));
  }
}

}  // namespace
}  // namespace hirosco
