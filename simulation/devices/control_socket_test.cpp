// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/control_socket.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace hirosco::simulation {
namespace {

class ControlSocketTest : public testing::Test {
 protected:
  ControlSocketTest() : path_{testing::TempDir() + "control-" + std::to_string(::getpid())} {}

  FileDescriptor connected() const {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path_.copy(address.sun_path, sizeof address.sun_path - 1);
    FileDescriptor client{::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0)};
    EXPECT_EQ(::connect(client.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    return client;
  }
  static void say(const FileDescriptor& client, const std::string& text) {
    (void)::send(client.get(), text.data(), text.size(), MSG_NOSIGNAL);
  }
  /// What came back; "closed" when the other side hung up.
  static std::string heard(const FileDescriptor& client) {
    std::array<char, 1024> buffer;
    const ssize_t got = ::recv(client.get(), buffer.data(), buffer.size(), 0);
    if (got == 0 || (got < 0 && errno == ECONNRESET)) return "closed";
    return {buffer.data(), got > 0 ? static_cast<std::size_t>(got) : 0};
  }
  void serve() {
    control_.serve([](std::string_view line) { return fmt::format("<{}>", line); });
  }

  std::string path_;
  ControlSocket control_;
};

TEST_F(ControlSocketTest, AnswersLineByLineHoweverTheyArrive) {
  ASSERT_TRUE(control_.listen(path_));
  const FileDescriptor client = connected();
  say(client, "one\ntw");
  serve();
  EXPECT_EQ(heard(client), "<one>\n");
  say(client, "o\n");
  serve();
  EXPECT_EQ(heard(client), "<two>\n");
}

TEST_F(ControlSocketTest, DisconnectsWhoSendsALineWithoutEnd) {
  ASSERT_TRUE(control_.listen(path_));
  const FileDescriptor client = connected();
  say(client, std::string(2000, 'x'));
  serve();
  EXPECT_EQ(heard(client), "closed");
}

TEST_F(ControlSocketTest, LetsAFifthClientWaitUntilOneLeaves) {
  ASSERT_TRUE(control_.listen(path_));
  std::array<FileDescriptor, 4> clients;
  for (auto& client : clients) client = connected();
  const FileDescriptor fifth = connected();
  say(fifth, "me\n");
  serve();
  EXPECT_EQ(heard(fifth), "");
  clients[2].reset();
  serve();
  serve();
  EXPECT_EQ(heard(fifth), "<me>\n");
}

TEST_F(ControlSocketTest, ReplacesAnAbandonedSocketButNeverALiveOneOrAFile) {
  ASSERT_TRUE(control_.listen(path_));
  ControlSocket second;
  EXPECT_FALSE(second.listen(path_)) << "somebody serves it";
  const std::string abandoned = path_ + "-abandoned";
  {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    abandoned.copy(address.sun_path, sizeof address.sun_path - 1);
    const FileDescriptor dead{::socket(AF_UNIX, SOCK_STREAM, 0)};
    ASSERT_EQ(::bind(dead.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  EXPECT_TRUE(second.listen(abandoned));
  const std::string file = path_ + "-file";
  std::ofstream{file} << "mine";
  ControlSocket third;
  EXPECT_FALSE(third.listen(file));
  EXPECT_TRUE(std::filesystem::is_regular_file(file));
  std::filesystem::remove(file);
}

TEST_F(ControlSocketTest, RefusesAPathThatDoesNotFit) {
  EXPECT_EQ(control_.listen(std::string(108, 'a')).error().code, ErrorCode::OutOfRange);
  EXPECT_EQ(control_.listen("").error().code, ErrorCode::OutOfRange);
}

}  // namespace
}  // namespace hirosco::simulation
