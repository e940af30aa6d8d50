// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/processor_set.hpp"

#include <gtest/gtest.h>

#include <array>

#include "hirosco/utilities/os/thread.hpp"

namespace hirosco {
namespace {

TEST(ProcessorSet, HoldsWhatItIsTold) {
  ProcessorSet set = ProcessorSet::of(std::array<std::uint16_t, 4>{2, 0, 1023, 1024});
  EXPECT_EQ(to_string(set), "0, 2, 1023") << "there are no more";
  EXPECT_EQ(set.count(), 3U);
  EXPECT_EQ(set.last(), 1023U);
  set.remove(1023);
  set.remove(7);
  EXPECT_EQ(set.last(), 2U);
  EXPECT_TRUE(set.has(0) && !set.has(1) && set.has(2) && !set.has(5000));
  set.add(ProcessorSet::of(std::array<std::uint16_t, 2>{1, 2}));
  EXPECT_EQ(to_string(set), "0, 1, 2");
  EXPECT_EQ(set.beyond(ProcessorSet::of(std::array<std::uint16_t, 2>{0, 2})), 1U);
  EXPECT_EQ(set.beyond(set), std::nullopt);
  EXPECT_EQ(ProcessorSet{}.last(), std::nullopt);
}

TEST(ProcessorSet, IsWhatTheThreadMayUse) {
  Thread::start("pinned", [] {
    const ProcessorSet before = ProcessorSet::of_this_thread();
    if (before.count() == 0) {  // a system without affinity
      EXPECT_EQ(ProcessorSet::of(std::array<std::uint16_t, 1>{0}).take().error().code, ErrorCode::Unavailable);
      EXPECT_FALSE(grants_processor(0));
      return;
    }
    const auto last = static_cast<std::uint16_t>(*before.last());
    EXPECT_TRUE(grants_processor(last));
    EXPECT_FALSE(grants_processor(ProcessorSet::most - 1)) << "no computer of ours has so many";
    EXPECT_EQ(to_string(ProcessorSet::of_this_thread()), to_string(before)) << "what was tried is undone";
    ASSERT_TRUE(ProcessorSet::of(std::array<std::uint16_t, 2>{last, 1023}).take()) << "what there is of it";
    EXPECT_EQ(to_string(ProcessorSet::of_this_thread()), std::to_string(last));
    EXPECT_EQ(ProcessorSet::of(std::array<std::uint16_t, 1>{1023}).take().error().code, ErrorCode::SystemFailure);
    EXPECT_EQ(ProcessorSet{}.take().error().code, ErrorCode::Unavailable);
  })->join();
}

}  // namespace
}  // namespace hirosco
