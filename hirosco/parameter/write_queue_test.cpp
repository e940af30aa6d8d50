// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/parameter/write_queue.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace hirosco {
namespace {

struct Pair {
  std::uint32_t first;
  std::uint32_t second;
};

class WriteQueueOfTwo : public ::testing::Test {
 protected:
  WriteQueueOfTwo() {
    const std::vector<ParameterSpec> specs{
        {"PAIR", {1, Type::Struct, 0}, {{"FIRST", Type::Uint32, 1}, {"SECOND", Type::Uint32, 1}}, true, {}},
        {"SINGLE", {1, Type::Uint32, 0}, {{"SINGLE", Type::Uint32, 1}}, false, {}}};
    dictionary_ = *Dictionary::make(specs);
    EXPECT_TRUE(dictionary_.publish("PAIR", pair_));
    EXPECT_TRUE(dictionary_.publish("SINGLE", single_));
  }
  static std::array<std::byte, 4> octets(std::uint32_t value) {
    std::array<std::byte, 4> out{};
    OctetWriter{out}.put(value);
    return out;
  }

  Dictionary dictionary_;
  Parameter<Pair> pair_{{1, 2}};
  Parameter<std::uint32_t> single_{3};
  WriteQueue queue_{2, 64};
};

TEST_F(WriteQueueOfTwo, AppliesAllOfABatchAtOnceAndNotBefore) {
  const auto ten = octets(10), eleven = octets(11), twelve = octets(12);
  const std::array<ParameterWrite, 3> writes{{{0, 0, ten}, {1, -1, eleven}, {0, 1, twelve}}};
  ASSERT_TRUE(queue_.enqueue(dictionary_, writes));
  EXPECT_EQ(pair_.load().first, 1u);
  EXPECT_EQ(queue_.waiting(), 1u);
  EXPECT_EQ(queue_.apply(dictionary_), 1u);
  EXPECT_EQ(queue_.waiting(), 0u);
  EXPECT_EQ(pair_.load().first, 10u);
  EXPECT_EQ(pair_.load().second, 12u);
  EXPECT_EQ(single_.load(), 11u);
  Pair seen{};
  ASSERT_TRUE(pair_.snapshot(seen));
  EXPECT_EQ(seen.second, 12u);
}

TEST_F(WriteQueueOfTwo, ShowsWhatWaitsUntilSomethingOfItIsFoundBad) {
  const auto ten = octets(10), eleven = octets(11), twelve = octets(12);
  ASSERT_TRUE(queue_.enqueue(dictionary_, {{{1, -1, ten}}}));
  ASSERT_EQ(queue_.apply(dictionary_), 1u);
  ASSERT_TRUE(queue_.enqueue(dictionary_, {{{0, 1, eleven}, {1, -1, twelve}}}));
  std::vector<std::uint32_t> seen;
  const auto look = [&](const ParameterWrite& write) {
    seen.push_back(OctetReader{write.value}.get<std::uint32_t>());
    return write.member < 0;
  };
  EXPECT_FALSE(queue_.all_waiting(look));
  EXPECT_EQ(seen, std::vector<std::uint32_t>{11}) << "what was applied waits no more, and one is enough";
  EXPECT_TRUE(queue_.all_waiting([](const ParameterWrite& write) { return write.value.size() == 4; }));
  EXPECT_EQ(queue_.waiting(), 1u) << "nothing is taken";
  ASSERT_EQ(queue_.apply(dictionary_), 1u);
  EXPECT_TRUE(queue_.all_waiting([](const ParameterWrite&) { return false; }));
}

TEST_F(WriteQueueOfTwo, KeepsTheOrderOfBatches) {
  for (std::uint32_t round = 0; round < 9; ++round) {
    const auto older = octets(round), newer = octets(round + 100);
    ASSERT_TRUE(queue_.enqueue(dictionary_, {{{1, -1, older}}}));
    ASSERT_TRUE(queue_.enqueue(dictionary_, {{{1, -1, newer}}}));
    EXPECT_EQ(queue_.apply(dictionary_), 2u);
    EXPECT_EQ(single_.load(), round + 100);
  }
}

TEST_F(WriteQueueOfTwo, RefusesWhenFullAndTakesAgainAfterApply) {
  const auto value = octets(5);
  ASSERT_TRUE(queue_.enqueue(dictionary_, {{{1, -1, value}}}));
  ASSERT_TRUE(queue_.enqueue(dictionary_, {{{1, -1, value}}}));
  EXPECT_EQ(queue_.enqueue(dictionary_, {{{1, -1, value}}}).error().code, ErrorCode::ResourceExhausted);
  EXPECT_EQ(queue_.apply(dictionary_), 2u);
  EXPECT_TRUE(queue_.enqueue(dictionary_, {{{1, -1, value}}}));
}

TEST_F(WriteQueueOfTwo, RefusesABatchWithOneBadWriteAsAWhole) {
  const auto value = octets(5);
  const std::array<std::byte, 3> three{};
  EXPECT_EQ(queue_.enqueue(dictionary_, {{{1, -1, value}, {7, -1, value}}}).error().code, ErrorCode::NotFound);
  EXPECT_EQ(queue_.enqueue(dictionary_, {{{1, -1, value}, {1, -1, three}}}).error().code, ErrorCode::Malformed);
  EXPECT_EQ(queue_.apply(dictionary_), 0u);
  EXPECT_EQ(single_.load(), 3u);
}

TEST_F(WriteQueueOfTwo, RefusesABatchLargerThanItsPlace) {
  const auto value = octets(5);
  const std::vector<ParameterWrite> fits(3, {1, -1, value});   // 4 + 3 * 16 octets
  const std::vector<ParameterWrite> large(4, {1, -1, value});  // 4 + 4 * 16 octets
  EXPECT_TRUE(queue_.enqueue(dictionary_, fits));
  EXPECT_EQ(queue_.enqueue(dictionary_, large).error().code, ErrorCode::OutOfRange);
}

TEST_F(WriteQueueOfTwo, PassesOverAParameterThatWasWithdrawn) {
  const auto value = octets(5);
  ASSERT_TRUE(queue_.enqueue(dictionary_, {{{1, -1, value}}}));
  dictionary_.unpublish_all();
  EXPECT_EQ(queue_.apply(dictionary_), 1u);
  EXPECT_EQ(single_.load(), 3u);
}

}  // namespace
}  // namespace hirosco
