// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/linux/memfd.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include "hirosco/utilities/os/shared_memory.hpp"

namespace hirosco {
namespace {

TEST(Memfd, CanNeitherGrowNorShrink) {
  const FileDescriptor memory = *memfd::create("test", 4096);
  EXPECT_NE(::ftruncate(memory.get(), 100), 0);
  EXPECT_NE(::ftruncate(memory.get(), 8192), 0);
  EXPECT_TRUE(memfd::verify(memory.get(), 4096, false));
  EXPECT_FALSE(memfd::create("test", 0));
}

TEST(Memfd, SealedWritersKeepTheirMappingAndNobodyGetsAnother) {
  const FileDescriptor memory = *memfd::create("test", 4096);
  const MappedMemory writer = *MappedMemory::map(memory.get(), 4096, MapMode::ReadWrite);
  EXPECT_FALSE(memfd::verify(memory.get(), 4096, true));
  ASSERT_TRUE(memfd::seal_writers(memory.get()));
  EXPECT_TRUE(memfd::verify(memory.get(), 4096, true));
  EXPECT_FALSE(MappedMemory::map(memory.get(), 4096, MapMode::ReadWrite));
  const MappedMemory reader = *MappedMemory::map(memory.get(), 4096, MapMode::ReadOnly);
  writer.octets()[1] = std::byte{9};
  EXPECT_EQ(reader.octets()[1], std::byte{9});
}

TEST(Memfd, VerifyTellsWrongSizeAndMissingSeals) {
  const FileDescriptor memory = *memfd::create("test", 4096);
  EXPECT_EQ(memfd::verify(memory.get(), 4095, false).error().code, ErrorCode::Mismatch);
  const std::string name = "/hirosco-memfd-test-" + std::to_string(::getpid());
  const auto named = SharedMemory::create(name.c_str(), 4096);
  ASSERT_TRUE(named);
  EXPECT_TRUE(SharedMemory::unlink(name.c_str()));
  EXPECT_EQ(memfd::verify(named->descriptor().get(), 4096, false).error().code, ErrorCode::Mismatch);
  EXPECT_FALSE(memfd::verify(-1, 4096, false));
}

}  // namespace
}  // namespace hirosco
