# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A means of transfer to devices by a word that has none yet: CAN, by a gateway process behind message queues. It passes the conformance of all flows, and
descriptors may ask for it."""
WHO = "a data flow"
BEFORE = "3 + 5"
GOAL = "own files + 1 row; its word in the schema"
MOST_FILES, MOST_EDITED = 2, 1
MOST_ASKED = 1
ASKED = [
    ("hirosco/descriptor/types.xsd", '<xs:enumeration value="message_queue"/>', '<xs:enumeration value="message_queue"/><xs:enumeration value="can"/>',
     "descriptor_test Schema.HasTheWordsOfEachEnumerationThatTheReaderTakesAndNoOthers"),
]
MADE = [("docs/interfaces/schema.md", "tools/check_schema.py")]
FILES = {"hirosco/data_transfer/device/can_gateway_flow.hpp": """\
#pragma once

#include <memory>
#include <string>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/flow_access.hpp"

namespace hirosco {

/// Frames in order to a gateway of a CAN bus, by POSIX message queues; each side owns the queue that it reads.
[[nodiscard]] Result<std::unique_ptr<DataFlow>> open_can_gateway_flow(const std::string& address, FlowSide side);

/// All queues of the user: no rule tells one from another.
void let_in_can_gateway(const std::string& address, Sandbox& sandbox);
[[nodiscard]] bool is_reached_by_can_gateway(const std::string& address, const Sandbox& sandbox);
inline constexpr FlowAccess can_gateway_access{let_in_can_gateway, is_reached_by_can_gateway};

}  // namespace hirosco
""", "hirosco/data_transfer/device/can_gateway_flow.cpp": """\
#include "hirosco/data_transfer/device/can_gateway_flow.hpp"

#include <fcntl.h>
#include <mqueue.h>
#include <poll.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace hirosco {
namespace {

class CanGatewayFlow final : public DataFlow {
 public:
  CanGatewayFlow(std::string own, std::string peer, mqd_t queue)
      : own_{std::move(own)}, peer_{std::move(peer)}, queue_{queue} {}
  ~CanGatewayFlow() override {
    ::mq_close(queue_);
    ::mq_unlink(own_.c_str());
  }

 private:
  Result<> do_send(Octets frame) noexcept override {
    if (frame.size() > max_frame_octets)
      return fail(ErrorCode::OutOfRange, "octets of frame", static_cast<std::int64_t>(frame.size()));
    const mqd_t to = ::mq_open(peer_.c_str(), O_WRONLY | O_NONBLOCK);
    if (to < 0) return fail(ErrorCode::Unavailable, "nobody listens", errno);
    const int sent = ::mq_send(to, reinterpret_cast<const char*>(frame.data()), frame.size(), 0);
    const int reason = errno;
    ::mq_close(to);
    return sent == 0 ? ok() : Result<>{fail(ErrorCode::Unavailable, "no room", reason)};
  }
  Result<Received> do_receive(MutableOctets buffer) noexcept override {
    std::array<char, max_frame_octets> frame;
    ssize_t octets = -1;
    for (ssize_t next = 0; next >= 0;) {
      next = ::mq_receive(queue_, frame.data(), frame.size(), nullptr);
      if (next >= 0) octets = next;
    }
    if (octets < 0) return Received{};
    if (static_cast<std::size_t>(octets) > buffer.size())
      return fail(ErrorCode::Malformed, "frame is longer than expected", octets);
    std::memcpy(buffer.data(), frame.data(), static_cast<std::size_t>(octets));
    return Received{Flow::New, static_cast<std::size_t>(octets)};
  }
  bool do_wait(Duration timeout) noexcept override {
    pollfd look{.fd = queue_, .events = POLLIN, .revents = 0};
    return ::poll(&look, 1, static_cast<int>(timeout / std::chrono::milliseconds{1})) > 0;
  }
  std::string own_, peer_;
  mqd_t queue_;
};

}  // namespace

Result<std::unique_ptr<DataFlow>> open_can_gateway_flow(const std::string& address, FlowSide side) {
  const std::string subsystem = "/" + address + ".subsystem", device = "/" + address + ".device";
  const auto& [own, peer] = side == FlowSide::Device ? std::tie(device, subsystem) : std::tie(subsystem, device);
  mq_attr room{};
  room.mq_maxmsg = 8;
  room.mq_msgsize = max_frame_octets;
  const mqd_t queue = ::mq_open(own.c_str(), O_RDONLY | O_NONBLOCK | O_CREAT | O_EXCL, 0600, &room);
  if (queue < 0 && errno == EEXIST) return fail(ErrorCode::AlreadyExists, "this side of the flow is open");
  if (queue < 0) return fail(ErrorCode::Unavailable, "message queue (a sandbox needs /dev/mqueue mounted)", errno);
  return std::make_unique<CanGatewayFlow>(own, peer, queue);
}

void let_in_can_gateway(const std::string&, Sandbox& sandbox) {
  let_write("/dev/mqueue", sandbox);
  sandbox.queues = true;
}

bool is_reached_by_can_gateway(const std::string&, const Sandbox& sandbox) { return sandbox.queues; }

}  // namespace hirosco
"""}
EDITS = [
    ("hirosco/data_transfer/device/linux_flow_means.cpp", '#include "hirosco/data_transfer/device/datagram_flow.hpp"\n',
     '#include "hirosco/data_transfer/device/can_gateway_flow.hpp"\n#include "hirosco/data_transfer/device/datagram_flow.hpp"\n'),
    ("hirosco/data_transfer/device/linux_flow_means.cpp", "    FlowMeans{Transfer::Udp,",
     "    FlowMeans{Transfer::Can, AddressForm::Name,\n              [](const FlowOpening& at) { return open_can_gateway_flow(at.address, at.side); },\n              can_gateway_access},\n    FlowMeans{Transfer::Udp,"),
]
SOURCES = ["hirosco/data_transfer/device/linux_flow_means.cpp", "hirosco/data_transfer/device/can_gateway_flow.cpp"]
FLOWN = ["tests/devices/means_flight.py", "can", "all message queues"]
PLACE = "/dev/mqueue"  # a sandbox lets nobody into what is not mounted, as in a container
TRY = """\
#include <mqueue.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "hirosco/data_transfer/device/flow_access.hpp"
#include "hirosco/data_transfer/device/system_flow_factory.hpp"
#include "hirosco/data_transfer/device/testing/flow_conformance.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "supervisor/platform/launch/subsystem_sandbox.hpp"

namespace hirosco::testing {
namespace {

struct CanGatewayTraits {
  using Factory = SystemFlowFactory;
  static constexpr bool knows_its_peer = false;
  static FlowAddress address() {
    static int number = 0;
    return {Transfer::Can, "hirosco-" + std::to_string(::getpid()) + "-" + std::to_string(number++)};
  }
};
INSTANTIATE_TYPED_TEST_SUITE_P(CanGateway, FlowConformance, CanGatewayTraits);

TEST(CanGatewayFlow, ADescriptorMayAskForIt) {
  const descriptor::FileSource source = [](const std::filesystem::path& file) {
    auto text = descriptor::file_system()(file);
    constexpr std::string_view now = "<Endnode transfer=\\"shared_memory\\"", then = "<Endnode transfer=\\"can\\"";
    text->replace(text->find(now), now.size(), then);
    return text;
  };
  const auto reading = descriptor::read_subsystem(HIROSCO_SOURCE_DIR "/hirosco/descriptor/testdata/flywheel.xml", source);
  for (const auto& problem : reading.problems) ADD_FAILURE() << problem.message;
  EXPECT_TRUE(reading.value);
}

TEST(CanGatewayFlow, IsOpenedInTheSandboxOfASubsystemThatHasADeviceByItAndReachesSecondInhibitsByIt) {
  descriptor::MissionSubsystem member;
  member.subsystem.file = "/missions/arm.xml";
  member.subsystem.configurations.resize(1);
  member.subsystem.configurations[0].devices.resize(1);
  auto& endnode = member.subsystem.configurations[0].devices[0].endnode;
  const FlowAddress at = CanGatewayTraits::address();
  endnode.transfer = at.transfer;
  endnode.address = at.address;
  const Sandbox sandbox = supervisor::make_sandbox(member, {}, {});
  EXPECT_TRUE(is_reached({Transfer::Can, "enable"}, sandbox));
  EXPECT_FALSE(is_reached({Transfer::Can, "enable"}, Sandbox{}));
  for (const std::string& lack : isolation_lacks())
    if (!lack.starts_with("every real-time priority")) GTEST_SKIP() << lack;
  SystemFlowFactory flows{""};
  const PreparedSandbox prepared{sandbox};
  const auto device = flows.open(at, FlowSide::Device).value();
  const pid_t child = ::fork();
  if (child == 0) {
    if (prepared.enter() != 0) ::_exit(99);
    const auto own = flows.open(at, FlowSide::Subsystem);
    ::_exit(own && (*own)->send(std::array{std::byte{7}}) ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status)) << "a call that is refused ends the process";
  const bool is_there = std::filesystem::exists("/dev/mqueue");  // what is not mounted nobody is let into
  EXPECT_EQ(WEXITSTATUS(status), is_there ? 0 : 1);
  std::array<std::byte, 8> frame{};
  EXPECT_EQ(device->receive(frame).value().octets, is_there ? 1u : 0u);
  ::mq_unlink(("/" + at.address + ".subsystem").c_str());
}

}  // namespace
}  // namespace hirosco::testing
"""
