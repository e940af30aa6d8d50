// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// What the supervisor does with messages of a subsystem that nobody can read (hazard SF9): it counts them, says so, and
// goes on with the next. Only a channel that is closed is a loss, and who has lost it is fenced at once.
#include <gtest/gtest.h>

#include <charconv>
#include <deque>
#include <map>
#include <variant>

#include "hirosco/pus/st05_event/event_message.hpp"
#include "simulation/devices/robot/robot_device.hpp"
#include "tests/integration/flight.hpp"

namespace hirosco::testing {
namespace {

using simulation::RobotDevice;

struct Raw {
  MessageKind kind{};
  std::vector<std::byte> octets;
};
/// A message, or what a channel says of one that it could not make out.
using Said = std::variant<Raw, ErrorCode>;

/// The supervisor's end of a member's channel, on which a test may speak, too.
class Injected final : public Channel {
 public:
  Injected(std::unique_ptr<Channel> channel, std::deque<Said>& said) : channel_{std::move(channel)}, said_{said} {}
  Result<> send(const Message& message) override { return channel_->send(message); }
  Result<Found> receive(MessageBuffer& buffer) override {
    if (said_.empty()) return channel_->receive(buffer);
    if (const auto* error = std::get_if<ErrorCode>(&said_.front())) {
      const ErrorCode code = *error;
      if (code != ErrorCode::Unavailable) said_.pop_front();  // closed is closed
      return fail(code, "message");
    }
    const Raw raw = std::get<Raw>(std::move(said_.front()));
    said_.pop_front();
    std::ranges::copy(raw.octets, buffer.octets.begin());
    return Found{Flow::New, {.kind = raw.kind, .packet = Octets{buffer.octets}.first(raw.octets.size())}};
  }

 private:
  std::unique_ptr<Channel> channel_;
  std::deque<Said>& said_;
};

const std::array members{"COMMUNICATION", "MANIPULATOR", "JOYSTICK"};

class DamagedChannel : public ::testing::Test {
 protected:
  DamagedChannel()
      : flight{{.edit = hand_rests, .wrap_channel = [this](std::string_view member, std::unique_ptr<Channel> channel) {
                  return std::make_unique<Injected>(std::move(channel), said[std::string{member}]);
                }}} {}
  void SetUp() override {
    ASSERT_TRUE(flight.commission()) << flight.story().text();
    robot = &flight.device<RobotDevice>("robot");
    flight.craft().run(100ms);
  }
  [[nodiscard]] std::uint16_t apid(std::string_view member) {
    return flight.mission().find_subsystem(member)->subsystem.id;
  }

  /// Says all that to the supervisor in the name of each, and counts what that has told of.
  void say(const std::vector<Said>& messages) {
    for (const char* member : members) {
      for (const Said& message : messages) said[member].push_back(message);
      wanted += messages.size();
    }
    flight.craft().run(1200ms);
    for (const char* member : members) EXPECT_TRUE(said[member].empty());
  }
  [[nodiscard]] std::size_t told() {
    std::size_t sum = 0;
    for (const auto& line : flight.story().lines()) {
      const auto end = line.text.find(" messages could not be read");
      if (end == std::string::npos) continue;
      const std::size_t begin = line.text.rfind(' ', end - 1) + 1;
      std::size_t count = 0;
      std::from_chars(line.text.data() + begin, line.text.data() + end, count);
      sum += count;
    }
    return sum;
  }
  void all_fly_on() {
    for (const char* member : members) EXPECT_EQ(flight.state(member), State::Operational) << member;
    EXPECT_TRUE(robot->active());
    EXPECT_FALSE(flight.story().has(" died")) << flight.story().text();
    EXPECT_FALSE(flight.story().has("plan ")) << flight.story().text();
    const auto ping = pus::write_telecommand(
        buffer_, {.apid = 10, .sequence_count = 9999, .ack = pus::ack_all, .service = 17, .subtype = 1, .source = 0},
        {});
    EXPECT_EQ(flight.send(*ping).subtype, 7) << "what follows is read";
  }
  [[nodiscard]] std::vector<std::byte> report(std::uint16_t from) {
    const std::array data{std::byte{1}, std::byte{2}, std::byte{3}};
    const auto packet =
        pus::write_telemetry(buffer_, {.apid = from, .sequence_count = 7, .service = 3, .subtype = 25}, data);
    return {packet->begin(), packet->end()};
  }

  std::map<std::string, std::deque<Said>> said;
  Flight flight;
  RobotDevice* robot{nullptr};
  std::size_t wanted{0};

 private:
  std::array<std::byte, max_packet_octets> buffer_{};
};

TEST_F(DamagedChannel, WhatTheChannelCouldNotMakeOutIsCountedAndTold) {
  say({ErrorCode::Malformed, ErrorCode::SystemFailure, ErrorCode::Malformed});
  EXPECT_EQ(told(), wanted) << flight.story().text();
  all_fly_on();
}

TEST_F(DamagedChannel, APacketOfAnyWrongLengthIsCountedAndTold) {
  for (const auto kind : {MessageKind::Packet, MessageKind::GroundTelecommand}) {
    std::vector<Said> messages;
    for (std::size_t octets = 0; octets < pus::primary_header_octets; ++octets)
      messages.push_back(Raw{kind, std::vector<std::byte>(octets)});
    say(messages);
  }
  auto whole = report(11);
  whole.push_back(std::byte{0});
  std::vector<Said> messages{Raw{MessageKind::Packet, whole}};
  for (std::size_t octets = pus::primary_header_octets; octets + 1 < whole.size(); ++octets)
    messages.push_back(Raw{MessageKind::Packet, {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(octets)}});
  say(messages);
  EXPECT_EQ(told(), wanted) << flight.story().text();
  all_fly_on();
}

TEST_F(DamagedChannel, AReportWithAFlippedBitOrOfAnotherIsCountedAndTold) {
  // The bit that makes it a telecommand: that is refused with a report, as each damaged telecommand is.
  constexpr std::size_t kind_bit = 4;
  for (const char* member : members) {
    const auto good = report(apid(member));
    for (std::size_t bit = 0; bit < good.size() * 8; ++bit) {
      if (bit == kind_bit) continue;
      auto damaged = good;
      damaged[bit / 8] ^= std::byte{1} << bit % 8;
      said[member].push_back(Raw{MessageKind::Packet, damaged});
      ++wanted;
    }
    said[member].push_back(Raw{MessageKind::Packet, report(99)});
    ++wanted;
  }
  flight.craft().run(2500ms);
  EXPECT_EQ(told(), wanted) << flight.story().text();
  all_fly_on();
}

TEST_F(DamagedChannel, ADamagedTelecommandIsRefusedAndChangesNothing) {
  const auto data = call_data("SAFE_ALL", {});
  const auto good = function_packet(1, 5, data);
  int refused = 0;
  flight.story().on_telemetry = [&](const pus::TelemetryView& packet) {
    if (packet.apid() == 1 && packet.service() == 1 && (packet.subtype() == 2 || packet.subtype() == 10)) ++refused;
  };
  int sent = 0;
  for (std::size_t octet = 1; octet < good.size(); ++octet) {
    auto damaged = good;
    damaged[octet] ^= std::byte{1};
    said["JOYSTICK"].push_back(Raw{MessageKind::Packet, damaged});
    said["COMMUNICATION"].push_back(Raw{MessageKind::GroundTelecommand, damaged});
    sent += 2;
    flight.craft().run(400ms);  // no more than a few a second are reported one by one
  }
  EXPECT_EQ(refused, sent);
  all_fly_on();
}

TEST_F(DamagedChannel, WhatOnlyTheGroundLinkMayBringIsNotReadFromAnybodyElse) {
  const auto stop = function_packet(1, 5, call_data("SAFE_ALL", {}));
  for (const char* member : {"MANIPULATOR", "JOYSTICK"})
    said[member].push_back(Raw{MessageKind::GroundTelecommand, stop});
  said["COMMUNICATION"].push_back(Raw{MessageKind::GroundTelecommand, report(2)});
  flight.craft().run(1200ms);
  EXPECT_EQ(told(), 3u) << flight.story().text();
  EXPECT_FALSE(flight.story().has("SAFE_ALL"));
  all_fly_on();
}

TEST_F(DamagedChannel, AnEventThatIsNoneIsCountedAndTold) {
  const auto event = [](std::initializer_list<int> octets) {
    Raw raw{MessageKind::Event, {}};
    for (const int octet : octets) raw.octets.push_back(static_cast<std::byte>(octet));
    return raw;
  };
  // Length, severity, whether it is reported, id.
  say({event({}), event({4}), event({4, 1}), event({4, 1, 0}), event({0, 1, 0, 1}), event({5, 1, 0, 1}),
       event({255, 1, 0, 1}), event({4, 2, 0, 1}), event({4, 255, 0, 1}), event({4, 1, 0, 0})});
  EXPECT_EQ(told(), wanted) << flight.story().text();
  all_fly_on();
}

TEST_F(DamagedChannel, AnEventWithoutItsValuesOrUnknownIsToldByWhatIsKnownOfIt) {
  const auto& robot_lost = *flight.mission().find_subsystem("MANIPULATOR")->subsystem.find_event("ROBOT_LOST");
  const auto say_event = [&](descriptor::Severity severity, std::uint16_t id) {
    std::array<std::byte, 64> buffer;
    const auto written = pus::write_event_message(buffer, {.severity = severity, .id = id, .auxiliary = {}});
    said["MANIPULATOR"].push_back(Raw{MessageKind::Event, {written->begin(), written->end()}});
    flight.craft().run(300ms);
  };
  say_event(descriptor::Severity::Info, 0x7ABC);
  EXPECT_TRUE(flight.story().has("MANIPULATOR info")) << flight.story().text();
  all_fly_on();
  // A damaged severity makes nothing harmless that the descriptor calls severe.
  say_event(descriptor::Severity::Info, robot_lost.id);
  EXPECT_TRUE(flight.story().has("plan network-down")) << flight.story().text();
  EXPECT_TRUE(flight.run_until_state("MANIPULATOR", State::Offline, 2s)) << flight.story().text();
}

TEST_F(DamagedChannel, AFloodOfDamageIsToldOnceASecondWithItsExactCount) {
  constexpr std::size_t messages = 20'000;
  for (std::size_t i = 0; i < messages; ++i) said["JOYSTICK"].push_back(ErrorCode::Malformed);
  flight.craft().run(4s);
  EXPECT_EQ(told(), messages);
  EXPECT_LE(flight.story().count("JOYSTICK: "), 4u) << flight.story().text();
  all_fly_on();
}

TEST_F(DamagedChannel, WhoClosesItsChannelIsFencedAtOnceAndEnded) {
  said["MANIPULATOR"].push_back(ErrorCode::Unavailable);
  flight.craft().run(11ms);  // the next step of the supervisor, which steps every 10 ms
  EXPECT_TRUE(flight.craft().guard().fenced(10));
  flight.craft().run(10ms);
  EXPECT_FALSE(robot->active());
  said["MANIPULATOR"].clear();
  flight.craft().run(1500ms);
  EXPECT_TRUE(flight.story().has("MANIPULATOR died: signal 9")) << flight.story().text();
}

}  // namespace
}  // namespace hirosco::testing
