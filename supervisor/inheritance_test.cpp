// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/inheritance.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <functional>
#include <map>
#include <new>
#include <optional>
#include <string>
#include <thread>

#include "hirosco/utilities/os/life.hpp"
#include "supervisor/platform/storage/testing/test_folder.hpp"
#include "supervisor/supervision/testing/small_mission.hpp"

/// What a supervisor finds under the numbers of the keeper, which are taken from this process for the time of a test.
namespace hirosco::supervisor {
namespace {

using namespace std::chrono_literals;

struct InheritanceTest : ::testing::Test {
  static constexpr std::array numbers{keeper_page_descriptor, keeper_store_descriptor, keeper_journal_descriptor,
                                      keeper_texts_descriptor};
  static constexpr int beyond_all = 100;
  std::map<int, FileDescriptor> before;
  TestFolder folder;

  void SetUp() override {
    // A number that is free would be given to the next thing that is opened.
    FileDescriptor nothing{::open("/dev/null", O_RDWR | O_CLOEXEC)};
    nothing.reset(::fcntl(nothing.get(), F_DUPFD_CLOEXEC, beyond_all));
    for (const int number : numbers) {
      before[number] = FileDescriptor{::fcntl(number, F_DUPFD_CLOEXEC, beyond_all)};
      ASSERT_EQ(::dup2(nothing.get(), number), number);
    }
  }
  void TearDown() override {
    for (const auto& [number, descriptor] : before) {
      if (descriptor) ::dup2(descriptor.get(), number);
      else ::close(number);
    }
  }
  /// The keeper holds so many octets under this number.
  static SharedMemory hold(int number, std::size_t octets) {
    auto memory = SharedMemory::create_anonymous("kept", octets).value();
    EXPECT_EQ(::dup2(memory.descriptor().get(), number), number);
    return memory;
  }
  static std::string read(const descriptor::FileSource& source, const std::filesystem::path& file) {
    const auto text = source(file);
    return text ? *text : "";
  }
  /// Of a file whose text somebody changes in flight.
  [[nodiscard]] std::filesystem::path write(const std::string& text) const {
    const auto file = folder.path() / "arm.xml";
    std::ofstream{file} << text;
    return file;
  }
  static TextsInForce::Texts texts(const std::filesystem::path& file, const std::string& text) {
    return {{file, std::make_shared<const std::string>(text)}};
  }
};

/// All that a keeper gives.
struct KeeperInheritance : InheritanceTest {
  std::optional<SharedMemory> page_memory, journal_memory, texts_memory;
  KeeperPage* page{nullptr};

  void SetUp() override {
    InheritanceTest::SetUp();
    page_memory = hold(keeper_page_descriptor, sizeof(KeeperPage));
    journal_memory = hold(keeper_journal_descriptor, journal_octets);
    texts_memory = hold(keeper_texts_descriptor, texts_octets);
    page = new (page_memory->octets().data()) KeeperPage{};
    page->starts = 1;
  }
};

TEST_F(InheritanceTest, WithoutAKeeperThereIsAPageOfItsOwnAndNobodyBeforeNorAfter) {
  Inheritance alone;
  EXPECT_FALSE(alone.goes_on());
  EXPECT_EQ(alone.page().starts.load(), 0U);
  alone.page().log_number = 7;
  EXPECT_EQ(alone.page().log_number.load(), 7U);
  EXPECT_EQ(Inheritance{}.page().log_number.load(), 0U) << "nobody after it reads that";
  EXPECT_EQ(alone.journal(), nullptr);
  const auto kept = alone.store().keep(0, {1, 1, 1, 1, 1});
  ASSERT_FALSE(kept);
  EXPECT_STREQ(kept.error().text, "there is no keeper");
}

TEST_F(InheritanceTest, WithoutAKeeperTheFilesAreReadWhateverWasNoted) {
  Inheritance alone;
  const auto file = write("of the disk");
  EXPECT_TRUE(alone.note(texts(file, "noted"))) << "nobody minds";
  alone.page().starts = 2;
  EXPECT_EQ(read(alone.source(), file), "of the disk");
}

TEST_F(InheritanceTest, MemoryThatIsTooShortIsNotTaken) {
  const SharedMemory page = hold(keeper_page_descriptor, sizeof(KeeperPage) - 1);
  const SharedMemory journal = hold(keeper_journal_descriptor, journal_octets - 1);
  Inheritance inheritance;
  inheritance.page().starts = 5;
  EXPECT_EQ(page.octets()[offsetof(KeeperPage, starts)], std::byte{0});
  EXPECT_EQ(inheritance.journal(), nullptr);
}

TEST_F(InheritanceTest, AKeeperWithAShorterPageIsOfAnotherBuildAndNotNone) {
  const SharedMemory page = hold(keeper_page_descriptor, sizeof(KeeperPage) - 1);
  EXPECT_FALSE(Inheritance{}.fits()) << "its craft may fly already";
  ::close(keeper_page_descriptor);
  EXPECT_TRUE(Inheritance{}.fits()) << "there is no keeper";
}

TEST_F(KeeperInheritance, AKeeperFitsWhosePageIsOfThisLayout) {
  EXPECT_TRUE(Inheritance{}.fits());
  page->layout = KeeperPage::layout_now - 1;
  EXPECT_FALSE(Inheritance{}.fits());
}

TEST_F(InheritanceTest, WhatGuardsTellIsNotedInThePageThatItHas) {
  descriptor::Mission mission = testing::small_mission();
  for (const std::size_t member : {0U, 1U}) {
    auto& device = mission.subsystems[member].subsystem.devices.emplace_back();
    device.name = "MOTOR";
    device.enable = descriptor::Endnode{};
  }
  Inheritance alone;
  const InhibitNotes notes = alone.notes(mission);
  EXPECT_EQ(notes.of(testing::arm, "MOTOR"), &alone.page().inhibits[0]);
  EXPECT_EQ(notes.of(testing::hand, "MOTOR"), &alone.page().inhibits[1]);
  EXPECT_EQ(notes.of(testing::hand, "LAMP"), nullptr);
}

TEST_F(KeeperInheritance, ThePageIsTheKeepersAndTheSecondSupervisorGoesOn) {
  Inheritance inheritance;
  EXPECT_FALSE(inheritance.goes_on()) << "it is the first";
  inheritance.page().supervisor = 11;
  EXPECT_EQ(page->supervisor.load(), 11U);
  page->starts = 2;
  EXPECT_TRUE(inheritance.goes_on());
}

TEST_F(KeeperInheritance, AFlightIsAsOldAsItsFirstSupervisorWhicheverTellsIt) {
  EXPECT_EQ(Inheritance{}.flight_began(TimePoint{10s}), TimePoint{10s});
  EXPECT_EQ(Inheritance{}.flight_began(TimePoint{12s}), TimePoint{10s});
  page->starts = 2;
  EXPECT_EQ(Inheritance{}.flight_began(TimePoint{70s}), TimePoint{10s}) << "what the first one told is not before it";
}

TEST_F(InheritanceTest, WithoutAKeeperAFlightIsAsOldAsItsSupervisor) {
  Inheritance alone;
  EXPECT_EQ(alone.flight_began(TimePoint{10s}), TimePoint{10s});
  EXPECT_EQ(alone.flight_began(TimePoint{11s}), TimePoint{10s});
}

TEST_F(KeeperInheritance, WhatIsHandedOverReachesTheKeepersStore) {
  auto ends = KeptStore::make_socket().value();
  ASSERT_EQ(::dup2(ends.second.get(), keeper_store_descriptor), keeper_store_descriptor);
  KeptStore store{std::move(ends.first)};
  const FileDescriptor one{::open("/dev/null", O_RDONLY | O_CLOEXEC)};
  ASSERT_TRUE(Inheritance{}.store().keep(4, {one.get(), one.get(), one.get(), one.get(), one.get()}));
  store.take();
  EXPECT_TRUE(store.holds(4));
}

TEST_F(KeeperInheritance, WhatTheSupervisorBeforeNotedInItsJournalIsThere) {
  const std::array words{std::byte{1}, std::byte{2}, std::byte{3}};
  {
    Inheritance first;
    ASSERT_NE(first.journal(), nullptr);
    ASSERT_TRUE(first.journal()->write(words));
  }
  Inheritance second;
  ASSERT_NE(second.journal(), nullptr);
  const Octets newest = second.journal()->newest();
  EXPECT_EQ(std::vector(newest.begin(), newest.end()), std::vector(words.begin(), words.end()));
}

TEST_F(KeeperInheritance, WhoGoesOnReadsWhatTheOneBeforeFlewAndNoFileThatItDidNot) {
  const auto file = write("<Subsystem/>");
  const auto other = folder.path() / "hand.xml";
  std::ofstream{other} << "there";
  {
    Inheritance first;
    ASSERT_TRUE(first.note(texts(file, "<Subsystem/>")));
    static_cast<void>(write("<Changed/>"));
    EXPECT_EQ(read(first.source(), file), "<Changed/>") << "the first one reads the files";
  }
  page->starts = 2;
  const auto source = Inheritance{}.source();
  EXPECT_EQ(read(source, file), "<Subsystem/>");
  const auto unknown = source(other);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code, ErrorCode::NotFound);
}

TEST_F(KeeperInheritance, WhoGoesOnHasTheTextsToGoBackToBesideThoseThatItHasRead) {
  const auto file = write("of the disk");
  descriptor::Mission mission;
  mission.texts = texts(file, "read");
  {
    Inheritance first;
    auto noted = texts(file, "flown");
    noted.merge(texts(file.native() + "@", "before"));
    ASSERT_TRUE(first.note(noted));
    first.add_kept_texts(mission);
    EXPECT_EQ(mission.texts.size(), 1U) << "nobody was before it";
  }
  page->starts = 2;
  Inheritance{}.add_kept_texts(mission);
  ASSERT_EQ(mission.texts.size(), 2U);
  EXPECT_EQ(*mission.texts.at(file), "read");
  EXPECT_EQ(*mission.texts.at(file.native() + "@"), "before");
}

TEST_F(KeeperInheritance, WhoGoesOnReadsTheFilesWhereNothingWasNotedOrWhatWasHadNoRoom) {
  const auto file = write("of the disk");
  page->starts = 2;
  EXPECT_EQ(read(Inheritance{}.source(), file), "of the disk");
  Inheritance second;
  ASSERT_TRUE(second.note(texts(file, "flown")));
  EXPECT_FALSE(second.note(texts(file, std::string(texts_octets, 'x'))));
  page->starts = 3;
  EXPECT_EQ(read(Inheritance{}.source(), file), "of the disk");
}

TEST_F(KeeperInheritance, TheKeeperSeesTheThreadThatIsWatchedLiveAndEndAndOfWhichStartItIs) {
  page->starts = 3;
  const Inheritance inheritance;
  std::thread{[&] {
    inheritance.watch_this_thread();
    EXPECT_EQ(life_of(page->guard_life), Life::Held);
    EXPECT_EQ(page->guarded.load(), 3U);
  }}.join();
  EXPECT_EQ(life_of(page->guard_life), Life::Ended);
}

/// A millisecond passes with each look at it, and something may happen after so many.
struct LookedAtClock final : Clock {
  std::function<void()> happens{};
  int after{0};
  mutable int looks{0};

 private:
  [[nodiscard]] TimePoint do_now() const noexcept override {
    if (++looks == after && happens) happens();
    return TimePoint{1ms * looks};
  }
  [[nodiscard]] OnboardTime do_onboard() const noexcept override { return {}; }
};

TEST_F(KeeperInheritance, InhibitsThatTheKeeperHasLetGoOfAreTakenAtOnce) {
  page->starts = 3;
  page->left_inhibits = 3;
  const LookedAtClock clock;
  Inheritance{}.take_inhibits(clock);
  EXPECT_EQ(page->wants_inhibits.load(), 3U);
  EXPECT_LE(clock.looks, 2);
}

TEST_F(KeeperInheritance, InhibitsAreTakenWhenTheKeeperLetsGoOfThemForThisStart) {
  page->starts = 3;
  page->left_inhibits = 2;
  LookedAtClock clock;
  clock.after = 40;
  clock.happens = [this] { page->left_inhibits = page->wants_inhibits.load(); };
  Inheritance{}.take_inhibits(clock);
  EXPECT_GE(clock.looks, 40) << "what it left for the one before is of no help";
  EXPECT_LE(clock.looks, 42);
}

TEST_F(KeeperInheritance, AKeeperThatLetsGoOfNothingIsWaitedForATenthOfASecond) {
  page->starts = 3;
  const LookedAtClock clock;
  Inheritance{}.take_inhibits(clock);
  EXPECT_GE(clock.now(), TimePoint{100ms});
  EXPECT_LE(clock.now(), TimePoint{105ms});
}

}  // namespace
}  // namespace hirosco::supervisor
