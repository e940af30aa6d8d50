// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/our_process.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string>

#include "supervisor/platform/storage/testing/test_folder.hpp"

/// Whom `hirosco safe` and `hirosco status` take for the keeper of a flight, and whom for its supervisor (docs/adr/0217).
namespace hirosco::tools {
namespace {

struct OurProcess : ::testing::Test {
  TestFolder folder;

  /// One that does nothing until it is ended, by a program of this name.
  [[nodiscard]] Process start(const std::string& name) const {
    const auto program = folder.path() / name;
    std::filesystem::copy_file("/bin/sh", program);
    auto started =
        Process::spawn({.executable = program.string(), .arguments = {"-c", "while :; do kill -STOP $$; done"}});
    EXPECT_TRUE(started);
    return std::move(*started);
  }
  /// It has ended, and nobody has heard of it.
  static void end(Process& process) {
    EXPECT_TRUE(process.send_signal(SIGKILL));
    pollfd ended{process.handle().get(), POLLIN, 0};
    EXPECT_EQ(::poll(&ended, 1, -1), 1);
  }
};

TEST_F(OurProcess, IsOneThatRunsAProgramOfOurs) {
  Process keeper = start("hirosco");
  EXPECT_TRUE(our_process(keeper.pid()));
  end(keeper);
  static_cast<void>(keeper.poll());
}

TEST_F(OurProcess, IsNoneThatHasEndedThoughWhoStartedItHasNotHeardOfThat) {
  Process keeper = start("hirosco");
  end(keeper);
  EXPECT_FALSE(our_process(keeper.pid()));
  static_cast<void>(keeper.poll());
}

TEST_F(OurProcess, IsNoneOfAnotherProgramThatHasItsNumber) {
  Process other = start("other");
  EXPECT_FALSE(our_process(other.pid()));
  end(other);
  static_cast<void>(other.poll());
  EXPECT_FALSE(our_process(0));
  EXPECT_FALSE(our_process(-1));
}

/// A UNIX socket at which a program of this name listens and takes nobody, as one that stands still; and a connection to it. When it is continued
/// it listens no more, and stands still again.
struct OurListener : OurProcess {
  static constexpr int its_socket = 9;
  FileDescriptor asks;

  [[nodiscard]] Process listen(const std::string& name) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string path = (folder.path() / "safe.socket").string();
    EXPECT_LT(path.size(), sizeof address.sun_path);
    std::memcpy(address.sun_path, path.c_str(), std::min(path.size(), sizeof address.sun_path - 1));
    const std::string program = (folder.path() / name).string();
    std::filesystem::copy_file("/bin/sh", program);
    FileDescriptor listener{::socket(AF_UNIX, SOCK_SEQPACKET, 0)};
    EXPECT_EQ(::bind(listener.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    const pid_t pid = ::fork();
    if (pid == 0) {
      if (::listen(listener.get(), 1) != 0 || ::dup2(listener.get(), its_socket) != its_socket) ::_exit(1);
      if (listener.get() != its_socket) ::close(listener.get());
      ::execl(program.c_str(), program.c_str(), "-c", "while :; do kill -STOP $$; exec 9>&-; done", nullptr);
      ::_exit(1);
    }
    stands_still(pid);
    listener.reset();
    asks.reset(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
    EXPECT_EQ(::connect(asks.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    auto process = Process::adopt(pid);
    EXPECT_TRUE(process);
    return std::move(*process);
  }
  static void stands_still(int pid) {
    int how = 0;
    EXPECT_EQ(::waitpid(pid, &how, WUNTRACED), pid);
    EXPECT_TRUE(WIFSTOPPED(how)) << how;
  }
};

TEST_F(OurListener, IsWhoListensThoughItStandsStill) {
  Process supervisor = listen("hirosco-supervisor");
  const auto found = our_listener(asks.get());
  ASSERT_TRUE(found);
  EXPECT_EQ(found->pid(), supervisor.pid());
  end(supervisor);
  static_cast<void>(supervisor.poll());
}

TEST_F(OurListener, IsNoneOfAnotherProgram) {
  Process other = listen("other");
  EXPECT_FALSE(our_listener(asks.get()));
  end(other);
  static_cast<void>(other.poll());
}

TEST_F(OurListener, IsNobodyBehindAConnectionThatHasEndedWhoeverHasItsNumber) {
  Process supervisor = listen("hirosco-supervisor");
  EXPECT_TRUE(supervisor.send_signal(SIGCONT));
  stands_still(supervisor.pid());
  EXPECT_TRUE(our_process(supervisor.pid()));
  EXPECT_FALSE(our_listener(asks.get()));
  end(supervisor);
  static_cast<void>(supervisor.poll());
  EXPECT_FALSE(our_listener(-1));
}

}  // namespace
}  // namespace hirosco::tools
