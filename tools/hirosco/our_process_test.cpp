// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/our_process.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

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

TEST_F(OurProcess, BehindAConnectionIsWhoListensAndOnlyIfItIsOneOfOurs) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = (folder.path() / "safe.socket").string();
  ASSERT_LT(path.size(), sizeof address.sun_path);
  std::memcpy(address.sun_path, path.c_str(), path.size());
  const FileDescriptor listener{::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0)};
  ASSERT_EQ(::bind(listener.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(::listen(listener.get(), 1), 0);
  const FileDescriptor asks{::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0)};
  ASSERT_EQ(::connect(asks.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(our_listener(asks.get()).has_value(), our_process(::getpid()).has_value()) << "it is this one";
  EXPECT_FALSE(our_listener(-1));
}

}  // namespace
}  // namespace hirosco::tools
