// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/realtime_links/link_memory.hpp"

#include <gtest/gtest.h>

#include "hirosco/data_transfer/memory/heap_memory.hpp"
#include "supervisor/supervision/testing/small_mission.hpp"

/// Beside what becomes of it in handshakes, in lent_handshakes_test.cpp.
namespace hirosco::supervisor {
namespace {

/// Link 3 takes the set of HAND that link 2 takes.
struct LinkMemoryTest : ::testing::Test {
  descriptor::Mission mission = [] {
    auto made = testing::small_mission();
    made.links.push_back(made.links[1]);
    made.links.back().id = 3;
    return made;
  }();
  HeapMemory heap;
  LinkMemory memory{mission, heap, standard_link_mechanisms()};
  pus::st128::Agreement agreement{
      LinkMethod::SharedMemory,      descriptor::ByteOrder::Little, LinkKind::Loaned, 0, 1ms, 1ms,
      {{"PIXEL", Type::Uint8, 1000}}};
  bool lends{true};
  std::uint32_t epoch{0};

  LinkMemory::Shared share(std::uint8_t link) {
    return memory.share(*mission.find_link(link), agreement, ++epoch, [&](std::uint8_t) { return lends; }).value();
  }
};

TEST_F(LinkMemoryTest, IsMadeForEachLinkThatCopies) {
  agreement.kind = LinkKind::Latest;
  const auto one = share(2), other = share(3);
  EXPECT_NE(one.memory.block(), other.memory.block());
  EXPECT_EQ(one.made, 1U);
  EXPECT_EQ(other.made, 2U);
}

TEST_F(LinkMemoryTest, OfASetThatIsLentIsThatOfTheFirstLink) {
  const auto one = share(2), other = share(3);
  EXPECT_EQ(one.memory.block(), other.memory.block());
  EXPECT_EQ(other.made, one.made);
}

TEST_F(LinkMemoryTest, IsMadeAnewWhenItsProducerLendsNoMore) {
  const auto one = share(2);
  lends = false;
  EXPECT_NE(share(3).memory.block(), one.memory.block());
}

TEST_F(LinkMemoryTest, IsMadeAnewForAnotherLayout) {
  const auto one = share(2);
  agreement.fields[0].count = 2000;
  EXPECT_NE(share(3).memory.block(), one.memory.block());
}

TEST_F(LinkMemoryTest, ThatSomebodyCouldNotLendInIsHandedToNobodyElse) {
  const auto one = share(2);
  memory.lend_no_more(one.made);
  EXPECT_NE(share(3).memory.block(), one.memory.block());
}

TEST_F(LinkMemoryTest, NothingCarriesWhatNoMechanismHas) {
  LinkMemory none{mission, heap, {}};
  EXPECT_EQ(none.mechanism_for(agreement), nullptr);
  EXPECT_NE(memory.mechanism_for(agreement), nullptr);
}

}  // namespace
}  // namespace hirosco::supervisor
