// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/life.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <new>
#include <vector>

#include "hirosco/utilities/os/thread.hpp"

namespace hirosco {
namespace {

/// For waits that end by what is waited for.
constexpr Duration long_enough = std::chrono::minutes{5};

/// Words of memory that is shared with processes forked from here; the second view may be read only.
struct Words {
  std::atomic<std::uint32_t>* written;
  const std::atomic<std::uint32_t>* looked_at;
  Words() {
    const int memory = ::memfd_create("words", 0);
    EXPECT_EQ(::ftruncate(memory, 4096), 0);
    written =
        new (::mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, memory, 0)) std::atomic<std::uint32_t>[8]{};
    looked_at = static_cast<const std::atomic<std::uint32_t>*>(::mmap(nullptr, 4096, PROT_READ, MAP_SHARED, memory, 0));
    ::close(memory);
  }
};

[[nodiscard]] pid_t hold_in_a_process(std::atomic<std::uint32_t>& word) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  static_cast<void>(hold_life(word));
  for (;;) ::pause();
}

/// Waits by what is tested.
void wait_while(const std::atomic<std::uint32_t>& word, Life life) {
  for (std::uint32_t seen = word.load(); life_of(seen) == life; seen = word.load())
    ASSERT_TRUE(wait_for_change(std::array{SeenWord{&word, seen}}, long_enough));
}

void end_of(pid_t child) {
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
}

TEST(Life, OfAProcessThatIsKilledIsMarkedByTheSystemAndWakesWhoWaitsOnReadOnlyMemory) {
  Words words;
  EXPECT_EQ(life_of(words.looked_at->load()), Life::Unknown);
  const pid_t child = hold_in_a_process(*words.written);
  wait_while(*words.looked_at, Life::Unknown);
  EXPECT_EQ(life_of(words.looked_at->load()), Life::Held);
  ::kill(child, SIGKILL);
  wait_while(*words.looked_at, Life::Held);
  EXPECT_EQ(life_of(words.looked_at->load()), Life::Ended);
  end_of(child);
}

TEST(Life, IsMarkedWhenAProcessEndsByItself) {
  Words words;
  const pid_t child = ::fork();
  if (child == 0) {
    static_cast<void>(hold_life(*words.written));
    ::_exit(0);
  }
  end_of(child);
  EXPECT_EQ(life_of(words.looked_at->load()), Life::Ended);
}

TEST(Life, OfAStoppedProcessIsHeld) {
  Words words;
  const pid_t child = hold_in_a_process(*words.written);
  wait_while(*words.looked_at, Life::Unknown);
  ::kill(child, SIGSTOP);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, WUNTRACED), child);
  EXPECT_EQ(life_of(words.looked_at->load()), Life::Held);
  ::kill(child, SIGKILL);
  end_of(child);
  EXPECT_EQ(life_of(words.looked_at->load()), Life::Ended);
}

TEST(Life, OfOneOfManyIsFound) {
  Words words;
  std::vector<pid_t> children;
  for (int i = 0; i < 8; ++i) {
    children.push_back(hold_in_a_process(words.written[i]));
    wait_while(words.looked_at[i], Life::Unknown);
  }
  ::kill(children[5], SIGKILL);
  std::array<SeenWord, 8> seen{};
  for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = {words.looked_at + i, words.looked_at[i].load()};
  while (life_of(words.looked_at[5].load()) == Life::Held) ASSERT_TRUE(wait_for_change(seen, long_enough));
  for (int i = 0; i < 8; ++i) EXPECT_EQ(life_of(words.looked_at[i].load()), i == 5 ? Life::Ended : Life::Held) << i;
  for (const pid_t child : children) ::kill(child, SIGKILL);
  for (const pid_t child : children) end_of(child);
}

TEST(Life, TellsThatAHolderHasCome) {
  Words words;
  pid_t child = 0;
  {
    auto waiter = Thread::start("waiter", [&] { wait_while(*words.looked_at, Life::Unknown); });
    ASSERT_TRUE(waiter);
    child = hold_in_a_process(*words.written);
  }  // it has seen it
  EXPECT_EQ(life_of(words.looked_at->load()), Life::Held);
  ::kill(child, SIGKILL);
  end_of(child);
}

TEST(Life, IsOfTheThreadThatHoldsIt) {
  Words words;
  {
    auto thread = Thread::start("holder", [&] { EXPECT_TRUE(hold_life(*words.written)); });
    ASSERT_TRUE(thread);
  }
  EXPECT_EQ(life_of(words.looked_at->load()), Life::Ended);
}

TEST(WaitForChange, EndsAtOnceWhereAWordSaysSomethingElseAlready) {
  const std::array<std::atomic<std::uint32_t>, 2> words{5, 7};
  EXPECT_TRUE(wait_for_change(std::array{SeenWord{&words[0], 5}, SeenWord{&words[1], 6}}, long_enough));
}

TEST(WaitForChange, EndsWhenItsTimeIsOver) {
  const std::atomic<std::uint32_t> word{5};
  EXPECT_TRUE(wait_for_change(std::array{SeenWord{&word, 5}}, std::chrono::milliseconds{1}));
}

TEST(WaitForChange, RefusesNoneAndMoreThanTheSystemTakes) {
  const std::atomic<std::uint32_t> word{5};
  const std::vector<SeenWord> many(most_seen_words + 1, SeenWord{&word, 5});
  EXPECT_EQ(wait_for_change({}, Duration{0}).error().code, ErrorCode::OutOfRange);
  EXPECT_EQ(wait_for_change(many, Duration{0}).error().code, ErrorCode::OutOfRange);
}

}  // namespace
}  // namespace hirosco
