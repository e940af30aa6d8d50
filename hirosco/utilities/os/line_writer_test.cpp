// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/line_writer.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <string_view>

#include "hirosco/utilities/os/file_descriptor.hpp"

/// Real pipes and a real terminal that take nothing.
namespace hirosco {
namespace {

using namespace std::chrono_literals;

constexpr int wait_ms = 10'000;

struct HeldPipe {
  FileDescriptor read, write;
  HeldPipe() {
    std::array<int, 2> ends{-1, -1};
    if (::pipe(ends.data()) != 0) return;
    read.reset(ends[0]);
    write.reset(ends[1]);
  }
  /// So that nobody else writes a single octet; returns how many were.
  [[nodiscard]] std::size_t fill() const {
    const int flags = ::fcntl(write.get(), F_GETFL);
    static_cast<void>(::fcntl(write.get(), F_SETFL, flags | O_NONBLOCK));
    std::size_t octets = 0;
    while (::write(write.get(), "#", 1) == 1) ++octets;
    static_cast<void>(::fcntl(write.get(), F_SETFL, flags));
    return octets;
  }
};

/// Up to this, which somebody has yet to write; what came when it does not.
[[nodiscard]] std::string read_until(const FileDescriptor& from, const std::string& last) {
  std::string all;
  pollfd look{from.get(), POLLIN, 0};
  while (!all.ends_with(last) && ::poll(&look, 1, wait_ms) == 1) {
    std::array<char, 4096> octets;
    const auto got = ::read(from.get(), octets.data(), octets.size());
    if (got <= 0) break;
    all.append(octets.data(), static_cast<std::size_t>(got));
  }
  return all;
}

TEST(LineWriter, WritesWhatIsSaidInItsOrder) {
  const HeldPipe pipe;
  LineWriter writer{pipe.write.get()};
  EXPECT_TRUE(writer.say("one\n"));
  EXPECT_TRUE(writer.say("two\n"));
  EXPECT_TRUE(writer.flush(10s));
  EXPECT_EQ(read_until(pipe.read, "two\n"), "one\ntwo\n");
}

TEST(LineWriter, WhoSpeaksToAFullPipeGoesOnAndWhatHadNoRoomIsCountedOnceSomebodyReads) {
  const HeldPipe pipe;
  const std::size_t before = pipe.fill();
  LineWriter writer{pipe.write.get()};
  constexpr std::size_t said = 1000;
  std::size_t taken = 0;
  for (std::size_t i = 0; i < said; ++i) taken += writer.say("line\n") ? 1 : 0;
  EXPECT_GE(taken, LineWriter::most_lines);
  EXPECT_LE(taken, LineWriter::most_lines + 1) << "one is on its way";
  EXPECT_FALSE(writer.flush(1ms));
  std::array<char, 65'536> octets;
  for (std::size_t left = before; left > 0;) {
    const auto got = ::read(pipe.read.get(), octets.data(), std::min(left, octets.size()));
    ASSERT_GT(got, 0);
    left -= static_cast<std::size_t>(got);
  }
  EXPECT_TRUE(writer.flush(10s));
  ASSERT_TRUE(writer.say("the end\n"));
  const std::string all = read_until(pipe.read, "the end\n");
  std::size_t lines = 0, counted = 0;
  for (auto at = all.find("line\n"); at != std::string::npos; at = all.find("line\n", at + 1)) ++lines;
  constexpr std::string_view note{"hirosco: "};
  for (auto at = all.find(note); at != std::string::npos; at = all.find(note, at + 1))
    counted += std::strtoul(all.c_str() + at + note.size(), nullptr, 10);
  EXPECT_EQ(lines, taken);
  EXPECT_EQ(counted, said - taken) << all;
}

TEST(LineWriter, ATerminalThatIsHeldByCtrlSHoldsUpNobodyAndHasItAllWhenItGoesOn) {
  const FileDescriptor terminal{::posix_openpt(O_RDWR | O_NOCTTY)};
  ASSERT_TRUE(terminal);
  ASSERT_EQ(::grantpt(terminal.get()), 0);
  ASSERT_EQ(::unlockpt(terminal.get()), 0);
  const FileDescriptor program{::open(::ptsname(terminal.get()), O_RDWR | O_NOCTTY)};
  ASSERT_TRUE(program);
  ASSERT_EQ(::tcflow(program.get(), TCOOFF), 0);
  LineWriter writer{program.get()};
  EXPECT_TRUE(writer.say("the supervisor is ended\n"));
  EXPECT_FALSE(writer.flush(20ms)) << "nothing is written";
  ASSERT_EQ(::tcflow(program.get(), TCOON), 0);
  EXPECT_TRUE(writer.flush(10s));
  EXPECT_EQ(read_until(terminal, "ended\r\n"), "the supervisor is ended\r\n");
}

TEST(LineWriter, APipeWhoseReaderIsGoneEndsNobody) {
  HeldPipe pipe;
  pipe.read.reset();
  ASSERT_NE(::signal(SIGPIPE, SIG_DFL), SIG_ERR);
  LineWriter writer{pipe.write.get()};
  EXPECT_TRUE(writer.say("nobody hears it\n"));
  EXPECT_TRUE(writer.flush(10s));
}

TEST(LineWriter, ItsEndWaitsForNobodyWhoReadsNothing) {
  const HeldPipe pipe;
  ASSERT_GT(pipe.fill(), 0U);
  {
    LineWriter writer{pipe.write.get()};
    EXPECT_TRUE(writer.say("held\n"));
  }
  SUCCEED() << "its thread is left behind, and ends with the pipe";
}

TEST(LineWriter, ALineThatIsTooLongIsCutOffAndOneLineAllTheSame) {
  const HeldPipe pipe;
  LineWriter writer{pipe.write.get()};
  EXPECT_TRUE(writer.say(std::string(3 * LineWriter::longest, 'x') + "\n"));
  EXPECT_EQ(read_until(pipe.read, "\n"), std::string(LineWriter::longest - 4, 'x') + "...\n");
}

}  // namespace
}  // namespace hirosco
