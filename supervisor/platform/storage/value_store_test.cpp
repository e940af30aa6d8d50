// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/value_store.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/semaphore.hpp"
#include "supervisor/platform/storage/testing/test_folder.hpp"

namespace hirosco::supervisor {
namespace {

[[nodiscard]] ValueCopy numbered(std::uint64_t number) { return {1, number, {}, std::vector<std::byte>(3)}; }

TEST(DirectValueStore, KeepsEachSubsystemsValuesForTheNextFlight) {
  MemoryValueDisk disk;
  DirectValueStore first{disk, "values"};
  first.keep("ARM", numbered(4));
  first.keep("HAND", numbered(9));
  const auto outcomes = first.take_outcomes();
  ASSERT_EQ(outcomes.size(), 2U);
  EXPECT_EQ(outcomes[1].subsystem, "HAND");
  EXPECT_EQ(outcomes[1].sequence, 9U);
  EXPECT_FALSE(outcomes[1].failure);
  EXPECT_TRUE(first.take_outcomes().empty());
  DirectValueStore next{disk, "values"};
  EXPECT_EQ(next.read("ARM")[0], numbered(4));
  EXPECT_EQ(next.read("HAND")[1], numbered(9));
}

TEST(ThreadedValueStore, HasWrittenWhenItIsGone) {
  const TestFolder folder;
  const SystemClock clock;
  {
    ThreadedValueStore store{clock, std::make_unique<SystemValueDisk>(), folder.path() / "v"};
    for (std::uint64_t number = 1; number <= 5; ++number) store.keep("ARM", numbered(number));
  }
  ThreadedValueStore next{clock, std::make_unique<SystemValueDisk>(), folder.path() / "v"};
  for (const auto& copy : next.read("ARM")) EXPECT_EQ(copy, numbered(5));
}

/// Takes nothing before it is let go.
class HangingDisk final : public MemoryValueDisk {
 public:
  HangingDisk(Semaphore& hangs, Semaphore& free) : hangs_{hangs}, free_{free} {}
  Result<> create(const Path& file, Octets octets) override {
    if (!let_go_) {
      hangs_.post();
      free_.wait();
      let_go_ = true;
    }
    return MemoryValueDisk::create(file, octets);
  }

 private:
  Semaphore& hangs_;
  Semaphore& free_;
  bool let_go_{false};
};

TEST(ThreadedValueStore, ADiskThatHangsHoldsNobodyUpAndGetsTheNewestAfterwards) {
  const SystemClock clock;
  Semaphore hangs, free;
  ThreadedValueStore store{clock, std::make_unique<HangingDisk>(hangs, free), "values"};
  store.keep("ARM", numbered(1));
  hangs.wait();
  store.keep("ARM", numbered(2));
  store.keep("ARM", numbered(3));
  EXPECT_TRUE(store.take_outcomes().empty());
  free.post();
  std::vector<std::uint64_t> kept;
  while (kept.empty() || kept.back() != 3)
    for (const KeptOutcome& outcome : store.take_outcomes()) kept.push_back(outcome.sequence);
  EXPECT_EQ(kept, (std::vector<std::uint64_t>{1, 3}));
}

TEST(ThreadedValueStore, TellsWhatTheDiskDoesNotTake) {
  const TestFolder folder;
  const SystemClock clock;
  SystemValueDisk disk;
  ASSERT_TRUE(disk.create(folder.path() / "file", {}));
  ThreadedValueStore store{clock, std::make_unique<SystemValueDisk>(), folder.path() / "file"};
  store.keep("ARM", numbered(1));
  std::vector<KeptOutcome> outcomes;
  while (outcomes.empty()) outcomes = store.take_outcomes();
  ASSERT_TRUE(outcomes.front().failure);
  EXPECT_EQ(outcomes.front().failure->code, ErrorCode::SystemFailure);
}

}  // namespace
}  // namespace hirosco::supervisor
