// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>

#include "hirosco/parameter/dictionary.hpp"
#include "hirosco/parameter/write_queue.hpp"
#include "hirosco/utilities/allocation_guard.hpp"

namespace hirosco {
namespace {

TEST(ParameterRealtime, TheCyclesSideUsesNoHeap) {
  const std::vector<ParameterSpec> specs{{"P", {1, Type::Double, 0}, {{"P", Type::Double, 9}}, false, {}}};
  auto dictionary = std::move(*Dictionary::make(specs));
  // The length is the descriptor's: as an array that has it from the beginning, it is set without the heap.
  Parameter<Sized<double, 16>> parameter;
  ASSERT_TRUE(dictionary.publish("P", parameter));
  WriteQueue queue{4, 256};
  const std::array<std::byte, 72> value{};
  ASSERT_TRUE(queue.enqueue(dictionary, {{{0, -1, value}}}));

  ASSERT_TRUE(RealtimeScope::hook_present());
  RealtimeScope scope;
  std::array<std::byte, 72> out{};
  const std::size_t applied = queue.apply(dictionary);
  parameter.store(parameter.load());
  const std::size_t octets = dictionary.encode(0, -1, out) + dictionary.snapshot_encode(0, -1, out);
  const bool decoded = dictionary.decode_into(0, -1, out).has_value() && !dictionary.decode_into(1, -1, out);
  const bool initialised = dictionary.initialise().has_value();
  const AllocationCount count = scope.count();

  EXPECT_EQ(count, AllocationCount{});
  EXPECT_EQ(applied, 1u);
  EXPECT_EQ(octets, 144u);
  EXPECT_TRUE(decoded && initialised);
}

}  // namespace
}  // namespace hirosco
