// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <memory_resource>
#include <optional>
#include <vector>

#include "hirosco/resource/counted.hpp"
#include "hirosco/subsystem/testing/inside.hpp"

/// The author's pools through the ten states: taken in Software-Init, given back in Software-Deinit (docs/adr/0215).
namespace hirosco {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using testing::Rig;
using ::testing::StartsWith;

/// Has a container and a block of its pools from Software-Init on, and gives back what it is told to.
struct Borrower final : Subsystem {
  std::optional<std::pmr::vector<double>> numbers;
  void* block{nullptr};
  bool keeps_block{false}, fails_deinit{false}, never_done{false};
  int inits{0}, deinits{0};
  using Subsystem::resources;

  bool give_block_back() { return resources().give_back(std::exchange(block, nullptr)); }

 protected:
  Result<Step> software_init() override {
    ++inits;
    numbers.emplace(&resources());
    numbers->reserve(8);
    if (block == nullptr) block = resources().try_allocate(1000);
    return done;
  }
  Result<Step> software_deinit() override {
    ++deinits;
    numbers.reset();
    if (!keeps_block) give_block_back();
    if (fails_deinit) return fail(ErrorCode::Internal, "planted");
    return never_done ? again : done;
  }
};

const std::string borrower_descriptor = R"(<Subsystem name="BORROWER" id="21">
    <Resources><Pool block="128" count="4"/><Pool block="1024" count="2"/></Resources>
    <Configuration name="C" id="1" sampling_us="1000"/></Subsystem>)";

struct PoolsOfStates : ::testing::Test {
  Borrower author;
  Rig rig{author, borrower_descriptor};

  [[nodiscard]] ResourceStatistics statistics() const { return rig.subsystem.meter().statistics(); }
  [[nodiscard]] bool gives() {
    void* const tried = author.resources().try_allocate(1);
    return tried != nullptr && author.resources().give_back(tried);
  }
  [[nodiscard]] int failures() { return rig.heard(descriptor::framework_event::state_failed); }
};

TEST_F(PoolsOfStates, AreThereFromSoftwareInitToSoftwareDeinitAndNeverInOffline) {
  EXPECT_FALSE(gives()) << "Offline holds none";
  for (int turn = 0; turn < 3; ++turn) {
    EXPECT_EQ(rig.set_state_now(State::PreOperational), "1 3 7");
    EXPECT_TRUE(gives());
    EXPECT_EQ(statistics().pool_used[0], 1U);
    EXPECT_EQ(statistics().pool_used[1], 1U);
    EXPECT_EQ(rig.set_state_now(State::Offline), "1 3 7");
    EXPECT_FALSE(gives());
    EXPECT_EQ(statistics().pool_used[0], 0U);
    EXPECT_GE(statistics().pool_high[0], 1U) << "the most ever";
  }
  EXPECT_EQ(failures(), 0);
}

TEST_F(PoolsOfStates, BlocksThatTheAuthorStillHoldsFailSoftwareDeinitWithTheirNumberAndKeepTheirMemory) {
  author.keeps_block = true;
  rig.set_state_now(State::PreOperational);
  // Kind 8, mismatch: one block.
  EXPECT_THAT(rig.set_state_now(State::Offline), StartsWith("1 3 8:0202ff080000000000000001"));
  EXPECT_EQ(rig.state(), State::Offline) << "a deinit that fails cannot stop the way down";
  EXPECT_THAT(rig.explanations, ElementsAre(EndsWith("SoftwareDeinit failed: blocks still held: 1 of 1024 octets")));
  EXPECT_EQ(failures(), 1);
  *static_cast<double*>(author.block) = 2.5;
  EXPECT_FALSE(gives()) << "nothing is given of them any more";
  rig.settle();
  EXPECT_EQ(failures(), 1) << "told once";
}

TEST_F(PoolsOfStates, ThatWereKeptGoAsSoonAsTheirBlocksHaveComeBackInOffline) {
  author.keeps_block = true;
  rig.set_state_now(State::PreOperational);
  rig.set_state_now(State::Offline);
  void* const held = author.block;
  EXPECT_TRUE(author.give_block_back());
  rig.service();
  EXPECT_FALSE(author.resources().give_back(held)) << "no pool is looked at any more";
  EXPECT_EQ(rig.set_state_now(State::PreOperational), "1 3 7");
  EXPECT_EQ(statistics().pool_used[1], 1U);
}

TEST_F(PoolsOfStates, ThatWereKeptGoOnInTheNextSoftwareInitWithWhatIsHeld) {
  author.keeps_block = true;
  rig.set_state_now(State::PreOperational);
  rig.set_state_now(State::Offline);
  *static_cast<double*>(author.block) = 2.5;
  EXPECT_EQ(rig.set_state_now(State::PreOperational), "1 3 7");
  EXPECT_TRUE(gives());
  EXPECT_EQ(*static_cast<double*>(author.block), 2.5);
  EXPECT_EQ(statistics().pool_used[1], 1U);
  author.keeps_block = false;
  EXPECT_EQ(rig.set_state_now(State::Offline), "1 3 7");
  author.keeps_block = true;
  rig.set_state_now(State::PreOperational);
  EXPECT_THAT(rig.set_state_now(State::Offline), StartsWith("1 3 8:")) << "told on each way down";
  EXPECT_EQ(failures(), 2);
}

TEST_F(PoolsOfStates, GoBackThoughTheAuthorsOwnSoftwareDeinitFails) {
  author.fails_deinit = true;
  rig.set_state_now(State::PreOperational);
  EXPECT_THAT(rig.set_state_now(State::Offline), StartsWith("1 3 8:"));
  EXPECT_EQ(failures(), 1);
  EXPECT_FALSE(gives());
  EXPECT_EQ(statistics().pool_used[1], 0U);
  EXPECT_EQ(rig.set_state_now(State::PreOperational), "1 3 7") << "nothing of the way up before was left";
}

TEST_F(PoolsOfStates, GoBackThoughTheAuthorsOwnSoftwareDeinitNeverEnds) {
  author.never_done = true;
  rig.set_state_now(State::PreOperational);
  rig.set_state(State::Offline);
  rig.service();
  ASSERT_EQ(rig.state(), State::SoftwareDeinit);
  EXPECT_TRUE(gives()) << "he is not done";
  rig.advance(10s + 1ms);
  rig.settle();
  EXPECT_EQ(rig.state(), State::Offline);
  EXPECT_EQ(failures(), 1);
  EXPECT_FALSE(gives());
  EXPECT_EQ(rig.set_state_now(State::PreOperational), "1 3 7");
}

/// What it publishes lies in its pools, and its Software-Deinit fails behind giving that back.
struct Lodger final : Subsystem {
  Counted<Parameter<double>> level;

 protected:
  Result<Step> software_init() override {
    HIROSCO_TRY_LET(level, make_counted<Parameter<double>>(resources()));
    publish("LEVEL", *level);
    return done;
  }
  Result<Step> software_deinit() override {
    level.reset();
    return fail(ErrorCode::Internal, "planted");
  }
};

TEST(ParametersInPools, AreUnknownBeforeTheirPoolsGoThoughSoftwareDeinitFails) {
  Lodger author;
  Rig rig{author, R"(<Subsystem name="LODGER" id="21"><Resources><Pool block="1024" count="2"/></Resources>
    <Parameters><ParamRef name="LEVEL" id="0" type="DOUBLE"/></Parameters>
    <Configuration name="C" id="1" sampling_us="1000"/></Subsystem>)"};
  const auto values_told = [&] {
    std::array<std::byte, 5> asked{};
    OctetWriter{asked}.put(std::uint8_t{1}).put(ParameterId{21, Type::Double, 0}.wire());
    rig.send(20, 1, asked);
    rig.service();
    return rig.reports(20, 2).size();
  };
  EXPECT_EQ(rig.set_state_now(State::PreOperational), "1 3 7");
  EXPECT_EQ(values_told(), 1U);
  EXPECT_THAT(rig.set_state_now(State::Offline), StartsWith("1 3 8:"));
  EXPECT_EQ(values_told(), 1U) << "nobody looks at memory that is gone";
  EXPECT_EQ(rig.set_state_now(State::PreOperational), "1 3 7") << "and it is published anew";
}

TEST_F(PoolsOfStates, OfAnAuthorWhoseSoftwareDeinitRunsOutOfTimeWithABlockAreToldByAFailureOfTheirOwn) {
  author.never_done = author.keeps_block = true;
  rig.set_state_now(State::PreOperational);
  const auto down = rig.set_state(State::Offline);
  rig.service();
  rig.advance(10s + 1ms);
  rig.settle();
  EXPECT_EQ(rig.state(), State::Offline);
  EXPECT_THAT(rig.outcome(down), StartsWith("1 3 8:0202"));
  EXPECT_EQ(failures(), 2) << "its time, and its block";
  EXPECT_FALSE(gives());
}

TEST_F(PoolsOfStates, StayWhileACycleHasNotComeToRest) {
  rig.bring_to(State::SafeOperational);
  rig.set_state(State::Offline);
  rig.service();  // the cycle is told to rest, and hangs
  rig.advance(11s);
  for (int i = 0; i < 5; ++i) rig.service();
  ASSERT_EQ(rig.state(), State::Offline);
  EXPECT_TRUE(gives()) << "it may be using them";
  rig.cycle();  // it rests
  rig.service();
  EXPECT_FALSE(gives());
}

TEST(PoolsThatCannotBeHad, FailSoftwareInitWithTheReasonAndTheAuthorIsNotAsked) {
  Borrower author;
  auto described = testing::read_descriptor(borrower_descriptor);
  // What no reader lets pass stands here for memory that is refused.
  described.resources.pools[1].block_octets = described.resources.pools[0].block_octets;
  Rig rig{author, described};
  EXPECT_THAT(rig.set_state_now(State::PreOperational), StartsWith("1 3 8:0202ff03"));
  EXPECT_EQ(rig.state(), State::Offline);
  EXPECT_THAT(rig.explanations,
              ElementsAre("BORROWER: SoftwareInit failed: its pools: two pools of one block size (128)"));
  EXPECT_EQ(author.inits, 0);
  EXPECT_EQ(author.deinits, 0) << "there is nothing to undo";
}

TEST(PoolsThatAreTried, GoBackWithWhatSoftwareInitTookOfThem) {
  Borrower author;
  Rig rig{author, borrower_descriptor};
  EXPECT_TRUE(rig.subsystem.try_introduction().empty());
  EXPECT_EQ(author.deinits, 1);
  EXPECT_EQ(author.block, nullptr);
  author.keeps_block = true;
  const auto mistakes = rig.subsystem.try_introduction();
  ASSERT_EQ(mistakes.size(), 1U);
  EXPECT_EQ(mistakes.front().text, "blocks still held: 1 of 1024 octets");
}

TEST(PoolsOfAnAuthor, OutliveEachFrameworkThatEndedWhileHeHeldBlocksOfThem) {
  Borrower author;
  author.keeps_block = true;
  std::vector<void*> held;
  for (int flight = 0; flight < 2; ++flight) {
    Rig rig{author, borrower_descriptor};
    rig.set_state_now(State::PreOperational);
    held.push_back(std::exchange(author.block, nullptr));
  }
  for (void* block : held) *static_cast<double*>(block) = 2.5;
}

TEST(PoolsOfAnAuthor, OutliveTheFrameworkWhileHeHoldsBlocksOfThem) {
  Borrower author;
  author.keeps_block = true;
  {
    Rig rig{author, borrower_descriptor};
    rig.set_state_now(State::PreOperational);
  }
  *static_cast<double*>(author.block) = 2.5;
  EXPECT_EQ(author.numbers->capacity(), 8U);
  author.numbers.reset();
}

}  // namespace
}  // namespace hirosco
