// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/stray_thread.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "hirosco/utilities/os/thread.hpp"

namespace hirosco {
namespace {

/// Another process with one more thread, of this name, that may use these processors.
class OtherProcess {
 public:
  OtherProcess(const char* name, const ProcessorSet& processors) {
    int ready[2];
    if (::pipe(ready) != 0) return;
    pid_ = ::fork();
    if (pid_ == 0) {
      auto thread = Thread::start(name, [&] {
        static_cast<void>(processors.take());
        static_cast<void>(!::write(ready[1], "x", 1));
        ::pause();
      });
      ::pause();
      ::_exit(0);
    }
    char octet = 0;
    EXPECT_EQ(::read(ready[0], &octet, 1), 1);
    ::close(ready[0]);
    ::close(ready[1]);
  }
  ~OtherProcess() {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  OtherProcess(const OtherProcess&) = delete;
  OtherProcess& operator=(const OtherProcess&) = delete;
  [[nodiscard]] int pid() const noexcept { return pid_; }

 private:
  int pid_{-1};
};

struct StrayThreadTest : ::testing::Test {
  const ProcessorSet all = ProcessorSet::of_this_thread();
  [[nodiscard]] ProcessorSet only(unsigned processor) const {
    ProcessorSet one;
    one.add(processor);
    return one;
  }
  const unsigned last = all.last().value_or(0);
  const unsigned first = all.beyond(ProcessorSet{}).value_or(0);
  /// Than the first; a computer with one processor does not have it, and who is given it is nowhere else either.
  const unsigned another = all.count() > 1 ? last : first + 1;
};

TEST_F(StrayThreadTest, ACycleOnItsOwnIsWhereItMayBe) {
  const OtherProcess other{"cycle", only(last)};
  EXPECT_FALSE(stray_thread(other.pid(), {.all = all, .cycle = last})) << "the first thread may go anywhere";
}

TEST_F(StrayThreadTest, ACycleOnAnotherThanItsOwnIsFoundWithItsNameAndWhere) {
  const OtherProcess other{"cycle", only(first)};
  const auto stray = stray_thread(other.pid(), {.all = all, .cycle = another});
  ASSERT_TRUE(stray);
  EXPECT_STREQ(stray->name.data(), "cycle");
  EXPECT_EQ(stray->processor, first);
}

TEST_F(StrayThreadTest, ACycleThatMayGoElsewhereTooIsFound) {
  const OtherProcess other{"cycle", all};
  EXPECT_TRUE(stray_thread(other.pid(), {.all = all, .cycle = another}));
}

TEST_F(StrayThreadTest, AnotherThreadGoesWhereAllMay) {
  const OtherProcess other{"cycling", only(first)};
  EXPECT_FALSE(stray_thread(other.pid(), {.all = all, .cycle = another}));
}

TEST_F(StrayThreadTest, WhoeverMayUseOneThatIsNotOfTheProcessIsFound) {
  const OtherProcess other{"helper", only(first)};
  const auto stray = stray_thread(other.pid(), {.all = only(another)});
  ASSERT_TRUE(stray);
  EXPECT_EQ(stray->processor, first);
}

TEST(StrayThread, OfAProcessThatIsNoneThereIsNone) { EXPECT_FALSE(stray_thread(-1, {})); }

}  // namespace
}  // namespace hirosco
