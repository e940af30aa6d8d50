// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/serial_flow.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <vector>

#include "hirosco/data_transfer/device/testing/streamed.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"

namespace hirosco {
namespace {

using testing::streamed;

TEST(SerialLine, IsAPathAndASpeedThatLinesHave) {
  EXPECT_EQ(read_serial_line("/dev/ttyUSB0@9600").value().path, "/dev/ttyUSB0");
  EXPECT_EQ(read_serial_line("/dev/ttyUSB0@9600").value().baud, 9600U);
  EXPECT_EQ(read_serial_line("arm").value().baud, 115'200U);
  EXPECT_EQ(read_serial_line("arm@4000000").value().baud, 4'000'000U);
  for (const char* text : {"", "@9600", "arm@", "arm@12345", "arm@9600x", "arm@-1"})
    EXPECT_FALSE(read_serial_line(text)) << text;
}

/// A pseudo-terminal of the test's own: what is behind a line that somebody else made.
struct Master {
  FileDescriptor end{::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)};
  std::string path;
  Master() {
    EXPECT_EQ(::grantpt(end.get()), 0);
    EXPECT_EQ(::unlockpt(end.get()), 0);
    path = ::ptsname(end.get());
  }
  void make_raw() const {
    termios settings{};
    ASSERT_EQ(::tcgetattr(end.get(), &settings), 0);
    ::cfmakeraw(&settings);
    ASSERT_EQ(::tcsetattr(end.get(), TCSANOW, &settings), 0);
  }
  void put(Octets octets) const {
    ASSERT_EQ(::write(end.get(), octets.data(), octets.size()), static_cast<ssize_t>(octets.size()));
  }
};

std::string unique_name() { return ::testing::TempDir() + "hirosco-line-" + std::to_string(::getpid()); }

TEST(SerialFlow, DoesNotTouchATerminalThatSomebodyTypesAt) {
  const Master terminal;
  termios before{}, after{};
  ASSERT_EQ(::tcgetattr(terminal.end.get(), &before), 0);
  const auto flow = open_serial_flow({.address = terminal.path}).value();
  EXPECT_FALSE(flow->send(std::array{std::byte{1}}));
  ASSERT_EQ(::tcgetattr(terminal.end.get(), &after), 0);
  EXPECT_EQ(before.c_lflag, after.c_lflag);
  EXPECT_EQ(before.c_oflag, after.c_oflag);
}

TEST(SerialFlow, CarriesEveryOctetAndCountsDamageOnTheWay) {
  const Master device;
  device.make_raw();
  const auto flow = open_serial_flow({.address = device.path}).value();
  std::array<std::byte, max_frame_octets> buffer{};
  // The system hands on what was put into a terminal when it has time, in as many pieces as it likes.
  std::uint64_t lost = 0;
  const auto take = [&] {
    EXPECT_TRUE(flow->wait(1h));
    const auto received = flow->receive(buffer).value();
    lost += received.damaged;
    return received;
  };
  auto damaged = streamed(1);
  damaged[9] ^= std::byte{0x80};
  for (std::uint64_t each = 1; each <= 2; ++each) {
    device.put(damaged);
    while (lost < each) take();
    EXPECT_EQ(lost, each) << "each of them, without a good one between";
  }
  device.put(streamed(2));
  device.put(Octets{streamed(2)}.subspan(5));  // begins in the middle
  device.put(streamed(3));
  auto received = take();
  while (received.flow != Flow::New || buffer[0] != std::byte{3}) received = take();
  EXPECT_EQ(received.octets, 40U);
  EXPECT_EQ(lost, 3U);
  // Those that a terminal would take for orders: end of line, interrupt, stop, escape.
  std::vector<std::byte> all(256);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::byte>(i);
  ASSERT_TRUE(flow->send(all));
  std::array<std::byte, max_streamed_octets> wire{};
  ASSERT_EQ(::read(device.end.get(), wire.data(), wire.size()), 256 + static_cast<ssize_t>(stream_overhead_octets));
  EXPECT_TRUE(std::ranges::equal(Octets{wire}.subspan(stream_head_octets, 256), all));
}

TEST(SerialFlow, OneProcessHasALine) {
  const Master device;
  device.make_raw();
  const auto flow = open_serial_flow({.address = device.path}).value();
  EXPECT_EQ(open_serial_flow({.address = device.path}).error().code, ErrorCode::AlreadyExists);
}

TEST(SerialFlow, WaitsForALineThatIsNotThereYet) {
  const std::string name = unique_name();
  const auto subsystem = open_serial_flow({.address = name}).value();
  std::array<std::byte, max_frame_octets> buffer{};
  EXPECT_EQ(subsystem->receive(buffer).value().flow, Flow::None) << "who never came has not gone";
  EXPECT_EQ(subsystem->send(buffer).error().code, ErrorCode::Unavailable);
  const auto device = open_serial_flow({.address = name, .side = FlowSide::Device}).value();
  while (!subsystem->send(std::array{std::byte{1}})) {}
  ASSERT_TRUE(device->wait(1h));
  EXPECT_EQ(device->receive(buffer).value().octets, 1U);
}

TEST(SerialFlow, LeavesNoLinkAndReplacesNoFile) {
  const std::string name = unique_name();
  { const auto device = open_serial_flow({.address = name, .side = FlowSide::Device}).value(); }
  EXPECT_FALSE(std::filesystem::is_symlink(name));
  std::ofstream{name} << "kept";
  EXPECT_EQ(open_serial_flow({.address = name, .side = FlowSide::Device}).error().code, ErrorCode::AlreadyExists);
  EXPECT_TRUE(std::filesystem::remove(name));
  // What a killed device left behind.
  std::filesystem::create_symlink("/dev/pts/999999", name);
  EXPECT_TRUE(open_serial_flow({.address = name, .side = FlowSide::Device}));
}

TEST(SerialFlow, HandsOctetsOfAnAuthorsProtocolOnAsTheyCome) {
  const Master device;
  device.make_raw();
  const auto flow = open_serial_flow({.address = device.path, .framing = Framing::Raw}).value();
  std::array<std::byte, max_frame_octets> buffer{};
  const std::array line{std::byte{'$'}, std::byte{'\r'}, std::byte{0}};
  device.put(line);
  ASSERT_TRUE(flow->wait(1h));
  EXPECT_EQ(flow->receive(buffer).value().octets, line.size());
  EXPECT_TRUE(std::ranges::equal(Octets{buffer}.first(line.size()), line));
  ASSERT_TRUE(flow->send(line));
  EXPECT_EQ(::read(device.end.get(), buffer.data(), buffer.size()), static_cast<ssize_t>(line.size()));
}

}  // namespace
}  // namespace hirosco
