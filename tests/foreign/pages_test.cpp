// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// The tables of docs/interfaces are what the code does: each row marked `octets` or `numbers` is compared, and nothing is missing.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "hirosco/data_transfer/channel/stream_frame.hpp"
#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/data_transfer/device/enable_frame.hpp"
#include "hirosco/data_transfer/device/power_frame.hpp"
#include "hirosco/data_transfer/device/shared_memory_flow.hpp"
#include "hirosco/data_transfer/device/stream_framing.hpp"
#include "hirosco/data_transfer/link/latest_link.hpp"
#include "hirosco/data_transfer/link/loaned_link.hpp"
#include "hirosco/data_transfer/link/queued_link.hpp"
#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/st05_event/event_message.hpp"
#include "hirosco/pus/st128_realtime_link/link_handshake.hpp"
#include "hirosco/subsystem/author/states.hpp"
#include "hirosco/subsystem/pages/page_words.hpp"
#include "hirosco/subsystem/pages/pages.hpp"
#include "tests/foreign/pages_tables.hpp"

namespace hirosco {
namespace {

template <class E>
[[nodiscard]] std::uint64_t of(E value) {
  return static_cast<std::uint64_t>(value);
}

#define HIROSCO_PLACE(type, member)                           \
  {                                                           \
    #member, { offsetof(type, member), sizeof(type::member) } \
  }

TEST(InterfacePages, VitalPage) {
  expect_octets("vital page", {HIROSCO_PLACE(VitalPage, magic),
                               HIROSCO_PLACE(VitalPage, version),
                               HIROSCO_PLACE(VitalPage, state),
                               HIROSCO_PLACE(VitalPage, configuration),
                               HIROSCO_PLACE(VitalPage, inhibited),
                               HIROSCO_PLACE(VitalPage, seen_epoch),
                               HIROSCO_PLACE(VitalPage, realtime),
                               HIROSCO_PLACE(VitalPage, cycling),
                               HIROSCO_PLACE(VitalPage, period_ns),
                               HIROSCO_PLACE(VitalPage, cycles),
                               HIROSCO_PLACE(VitalPage, service_steps),
                               HIROSCO_PLACE(VitalPage, overruns),
                               HIROSCO_PLACE(VitalPage, missed),
                               HIROSCO_PLACE(VitalPage, latency_max_ns),
                               HIROSCO_PLACE(VitalPage, execution_max_ns),
                               HIROSCO_PLACE(VitalPage, execution_mean_ns),
                               HIROSCO_PLACE(VitalPage, lost_reports),
                               HIROSCO_PLACE(VitalPage, inhibited_at_cycle),
                               HIROSCO_PLACE(VitalPage, incoming),
                               HIROSCO_PLACE(VitalPage, counters),
                               HIROSCO_PLACE(VitalPage, life),
                               HIROSCO_PLACE(VitalPage, latencies),
                               HIROSCO_PLACE(VitalPage, judged)});
  EXPECT_EQ(sizeof(VitalPage), 4976U) << "a field more: docs/interfaces lacks it";
  EXPECT_EQ(table("octets: vital page")[0].at(4).substr(0, 10), "0x48495243");
  EXPECT_EQ(page_magic, 0x48495243U);
  EXPECT_EQ(number_of(table("octets: vital page")[1].at(4)), page_version);
  expect_octets("incoming link",
                {HIROSCO_PLACE(IncomingLink, link), HIROSCO_PLACE(IncomingLink, lost),
                 HIROSCO_PLACE(IncomingLink, latency_mean_ns), HIROSCO_PLACE(IncomingLink, latency_max_ns),
                 HIROSCO_PLACE(IncomingLink, jitter_ns), HIROSCO_PLACE(IncomingLink, age_us)});
  expect_octets("link latencies", {HIROSCO_PLACE(LinkLatencies, period_ns), HIROSCO_PLACE(LinkLatencies, counts)});
  expect_numbers("judgements", {{link_not_judged, "not judged"}, {link_valid, "valid"}, {link_stale, "stale"}});
  using pus::CounterBlock;
  expect_octets("counter block", {HIROSCO_PLACE(CounterBlock, used), HIROSCO_PLACE(CounterBlock, sequence),
                                  HIROSCO_PLACE(CounterBlock, spare), HIROSCO_PLACE(CounterBlock, types)});
  using Type = CounterBlock::MessageType;
  expect_octets("message type", {HIROSCO_PLACE(Type, destination), HIROSCO_PLACE(Type, service),
                                 HIROSCO_PLACE(Type, subtype), HIROSCO_PLACE(Type, count), HIROSCO_PLACE(Type, spare)});
  expect_numbers("inhibitions", {{inhibited_by_stop, "stop"},
                                 {inhibited_by_link, "link"},
                                 {inhibited_by_device, "device"},
                                 {inhibited_by_author, "author"},
                                 {inhibited_by_failure, "failure"},
                                 {inhibited_by_supervisor, "supervisor"},
                                 {inhibited_while_awaited, "fall_back"}});
  const CheckedWord three{3};
  std::uint32_t raw;
  std::memcpy(&raw, &three, sizeof raw);
  EXPECT_EQ(raw, 0xFFFC'0003U) << "as the page says of checked words";
}

TEST(InterfacePages, PermitPage) {
  expect_octets("permit page",
                {HIROSCO_PLACE(PermitPage, magic), HIROSCO_PLACE(PermitPage, version), HIROSCO_PLACE(PermitPage, epoch),
                 HIROSCO_PLACE(PermitPage, stop), HIROSCO_PLACE(PermitPage, go), HIROSCO_PLACE(PermitPage, mode_epoch),
                 HIROSCO_PLACE(PermitPage, newest_stop), HIROSCO_PLACE(PermitPage, heartbeat),
                 HIROSCO_PLACE(PermitPage, stopped_at_cycle), HIROSCO_PLACE(PermitPage, powered)});
  EXPECT_EQ(sizeof(PermitPage), 56U);
  for (const Row& row : table("numbers: permission words"))
    EXPECT_EQ(number_of(row.at(1)), permission_word(static_cast<std::uint32_t>(number_of(row[0])))) << row[0];
}

TEST(InterfacePages, Links) {
  expect_octets("link header", {{"magic", {link_memory::magic_at, 8}},
                                {"version_epoch", {link_memory::version_epoch_at, 8}},
                                {"payload_octets", {link_memory::payload_octets_at, 8}},
                                {"layout_hash", {link_memory::layout_hash_at, 8}},
                                {"period", {link_memory::period_at, 8}}});
  using Header = std::array<std::size_t, 5>;
  const Header places{link_memory::magic_at, link_memory::version_epoch_at, link_memory::payload_octets_at,
                      link_memory::layout_hash_at, link_memory::period_at};
  EXPECT_EQ((Header{loaned_memory::magic_at, loaned_memory::version_epoch_at, loaned_memory::payload_octets_at,
                    loaned_memory::layout_hash_at, loaned_memory::period_at}),
            places);
  EXPECT_EQ((Header{queued_memory::magic_at, queued_memory::version_epoch_at, queued_memory::payload_octets_at,
                    queued_memory::layout_hash_at, queued_memory::period_at}),
            places);
  std::map<std::string, std::pair<std::uint64_t, std::uint64_t>> kinds;
  for (const Row& row : table("numbers: link magic")) kinds[row.at(1)] = {number_of(row[0]), number_of(row.at(2))};
  const decltype(kinds) built{{"latest", {link_memory::magic, link_memory::version}},
                              {"loaned", {loaned_memory::magic, loaned_memory::version}},
                              {"queued", {queued_memory::magic, queued_memory::version}}};
  EXPECT_EQ(kinds, built);
  expect_octets("latest link", {{"sequence", {link_memory::sequence_at, 8}},
                                {"status", {link_memory::status_at, 8}},
                                {"count", {link_memory::count_at, 8}},
                                {"stamp", {link_memory::stamp_at, 8}},
                                {"payload", {link_memory::payload_at, 8}}});
  expect_octets("queued link", {{"depth", {queued_memory::depth_at, 8}},
                                {"newest", {queued_memory::newest_at, 8}},
                                {"status", {queued_memory::status_at, 8}},
                                {"stamp", {queued_memory::stamp_at, 8}},
                                {"slots", {queued_memory::slots_at, 64}}});
  expect_octets("queued slot", {{"sequence", {queued_memory::sequence_in_slot, 8}},
                                {"status", {queued_memory::status_in_slot, 8}},
                                {"stamp", {queued_memory::stamp_in_slot, 8}},
                                {"payload", {queued_memory::payload_in_slot, 8}}});
  expect_octets("loaned link", {{"newest", {loaned_memory::newest_at, 8}},
                                {"sequence", {loaned_memory::sequence_at(0), 8}},
                                {"status", {loaned_memory::status_at(0), 8}},
                                {"stamp", {loaned_memory::stamp_at(0), 8}},
                                {"payload", {loaned_memory::payload_at, 64}}});
  EXPECT_EQ(loaned_memory::sequence_at(3), 128U + 64 * 3);
  EXPECT_EQ(loaned_memory::places, 4U);
  for (const std::uint32_t payload : {1U, 8U, 9U, 31U, 32U, 33U, 256U}) {
    const auto up = [](std::size_t octets, std::size_t multiple) {
      return (octets + multiple - 1) / multiple * multiple;
    };
    EXPECT_EQ(link_memory_octets(payload), up(96 + up(payload, 8), 64));
    EXPECT_EQ(queued_memory::slot_octets(payload), up(24 + payload, 64));
    EXPECT_EQ(queued_memory_octets(payload, 7), 128 + 8 * up(24 + payload, 64));
    EXPECT_EQ(loaned_memory_octets(payload), 384 + 4 * up(payload, 64));
  }
  expect_numbers("link status", {{of(LinkStatus::None), "None"},
                                 {of(LinkStatus::Valid), "Valid"},
                                 {of(LinkStatus::Degraded), "Degraded"},
                                 {of(LinkStatus::Stopping), "Stopping"},
                                 {of(LinkStatus::Fault), "Fault"}});
}

TEST(InterfacePages, Packets) {
  expect_octets("envelope", {{"kind", {0, 1}}, {"version", {1, 1}}, {"link", {2, 2}}, {"epoch", {4, 4}}});
  std::array<std::byte, envelope::octets> head;
  OctetWriter writer{head};
  envelope::write(writer, {.kind = MessageKind::Event, .epoch = 0x04050607, .link = 0x0203});
  constexpr std::array<unsigned char, 8> expected{3, envelope::version, 2, 3, 4, 5, 6, 7};
  EXPECT_EQ(std::memcmp(head.data(), expected.data(), head.size()), 0);
  EXPECT_EQ(number_of(table("octets: envelope")[1].at(4)), envelope::version);
  expect_numbers("message kinds", {{of(MessageKind::Packet), "Packet"},
                                   {of(MessageKind::GroundTelecommand), "GroundTelecommand"},
                                   {of(MessageKind::Event), "Event"},
                                   {of(MessageKind::PermitPage), "PermitPage"}});
  std::map<std::uint64_t, std::string> types;
  for (const auto& row : EnumTexts<Type>::table) types[of(row.value)] = row.text;
  expect_numbers("types", types);

  // Where things stand in packets, of packets with marked values.
  std::array<std::byte, 64> buffer{};
  const std::array data{std::byte{0xAA}};
  const auto octet = [&](std::size_t at) { return std::to_integer<unsigned>(buffer[at]); };
  const auto u16_at = [&](std::size_t at) { return octet(at) << 8 | octet(at + 1); };
  const Place telecommand{
      {"identification", {0, 2}}, {"sequence", {2, 2}}, {"length", {4, 2}}, {"version_acknowledge", {6, 1}},
      {"service", {7, 1}},        {"subtype", {8, 1}},  {"source", {9, 2}}, {"data", {11, 0}}};
  expect_octets("telecommand", telecommand);
  ASSERT_TRUE(pus::write_telecommand(
      buffer, {.apid = 0x123, .sequence_count = 0x456, .ack = 9, .service = 8, .subtype = 7, .source = 0xBCDE}, data));
  EXPECT_EQ(u16_at(0), 0x1800U | 0x123);
  EXPECT_EQ(u16_at(2), 0xC000U | 0x456);
  EXPECT_EQ(u16_at(4), pus::telecommand_overhead_octets + 1 - 7);
  EXPECT_EQ(octet(6), 0x29U);
  EXPECT_EQ(octet(7), 8U);
  EXPECT_EQ(octet(8), 7U);
  EXPECT_EQ(u16_at(9), 0xBCDEU);
  EXPECT_EQ(octet(11), 0xAAU);
  const Place telemetry{{"identification", {0, 2}}, {"sequence", {2, 2}},     {"length", {4, 2}},
                        {"version_time", {6, 1}},   {"service", {7, 1}},      {"subtype", {8, 1}},
                        {"message_count", {9, 2}},  {"destination", {11, 2}}, {"time", {13, 7}},
                        {"data", {20, 0}}};
  expect_octets("telemetry", telemetry);
  ASSERT_TRUE(pus::write_telemetry(buffer,
                                   {.apid = 0x123,
                                    .sequence_count = 0x456,
                                    .service = 8,
                                    .subtype = 7,
                                    .message_count = 0xFACE,
                                    .destination = 0xBCDE,
                                    .time = OnboardTime{std::chrono::seconds{0x01020304}}},
                                   data));
  EXPECT_EQ(u16_at(0), 0x0800U | 0x123);
  EXPECT_EQ(u16_at(4), pus::telemetry_overhead_octets + 1 - 7);
  EXPECT_EQ(octet(6), 0x20U);
  EXPECT_EQ(octet(7), 8U);
  EXPECT_EQ(octet(8), 7U);
  EXPECT_EQ(u16_at(9), 0xFACEU);
  EXPECT_EQ(u16_at(11), 0xBCDEU);
  EXPECT_EQ(u16_at(13), 0x0102U);
  EXPECT_EQ(u16_at(15), 0x0304U);
  EXPECT_EQ(octet(20), 0xAAU);
  expect_octets("event message", {{"severity", {0, 1}},
                                  {"reported", {1, 1}},
                                  {"id", {pus::event_message_id_at, 2}},
                                  {"arguments", {pus::event_message_head_octets, 0}}});
}

TEST(InterfacePages, CodesAndWords) {
  // Those that a subsystem says, in words. Which they are says docs/failure-codes.md, of which the table is made (tools/check_interfaces.py)
  // and where each code has its row.
  EXPECT_FALSE(table("numbers: failure codes").empty());
  for (const Row& row : table("numbers: failure codes"))
    EXPECT_EQ(row.at(1), to_text(static_cast<pus::FailureCode>(number_of(row[0])))) << row[0];
  expect_numbers("kinds of error", {{of(ErrorCode::InvalidArgument), "InvalidArgument"},
                                    {of(ErrorCode::OutOfRange), "OutOfRange"},
                                    {of(ErrorCode::NotFound), "NotFound"},
                                    {of(ErrorCode::AlreadyExists), "AlreadyExists"},
                                    {of(ErrorCode::NotPermitted), "NotPermitted"},
                                    {of(ErrorCode::Unavailable), "Unavailable"},
                                    {of(ErrorCode::ResourceExhausted), "ResourceExhausted"},
                                    {of(ErrorCode::Malformed), "Malformed"},
                                    {of(ErrorCode::Mismatch), "Mismatch"},
                                    {of(ErrorCode::Timeout), "Timeout"},
                                    {of(ErrorCode::SystemFailure), "SystemFailure"},
                                    {of(ErrorCode::Internal), "Internal"}});
  expect_numbers("device loss", {{of(descriptor::DeviceLoss::Silent), "Silent"},
                                 {of(descriptor::DeviceLoss::HungUp), "HungUp"},
                                 {of(descriptor::DeviceLoss::Damaged), "Damaged"},
                                 {of(descriptor::DeviceLoss::WrongSize), "WrongSize"},
                                 {of(descriptor::DeviceLoss::Repeated), "Repeated"},
                                 {of(descriptor::DeviceLoss::LetGo), "LetGo"},
                                 {of(descriptor::DeviceLoss::NotOpened), "NotOpened"},
                                 {of(descriptor::DeviceLoss::OldEpoch), "OldEpoch"},
                                 {of(descriptor::DeviceLoss::NeverHeard), "NeverHeard"},
                                 {of(descriptor::DeviceLoss::OtherVersion), "OtherVersion"}});
  descriptor::SubsystemDescriptor bare;
  bare.devices.emplace_back().name = "NAME";
  descriptor::Configuration& used = bare.configurations.emplace_back();
  used.requires_.emplace_back().name = "NAME";
  used.devices.emplace_back().fall_backs.emplace_back();
  bare.parameters.emplace_back().from = "OTHER.VALUE";
  bare.service_loops.emplace_back();
  descriptor::add_framework_events(bare);
  std::map<std::uint64_t, std::string> events, severities;
  for (const descriptor::Event& event : bare.events) {
    events[event.id] = event.name;
    severities[event.id] = to_text(event.severity);
  }
  expect_numbers("framework events", events);
  for (const Row& row : table("numbers: framework events"))
    EXPECT_EQ(row.at(2), severities[number_of(row[0])]) << row[1];
  namespace st128 = pus::st128;
  EXPECT_EQ(of(LinkMethod::SharedMemory), 1U);
  EXPECT_EQ(table("numbers: link terms").size(), 6U);
  for (const Row& row : table("numbers: link terms")) {
    const std::string& name = row.at(1);
    const std::uint64_t number = name == "shared_memory" ? of(LinkMethod::SharedMemory)
                                 : name == "little"      ? of(descriptor::ByteOrder::Little)
                                 : name == "big"         ? of(descriptor::ByteOrder::Big)
                                 : name == "latest"      ? of(LinkKind::Latest)
                                 : name == "queued"      ? of(LinkKind::Queued)
                                                         : of(LinkKind::Loaned);
    EXPECT_EQ(number_of(row[0]), number) << name;
  }
  std::array<std::byte, 128> buffer{};
  const auto octets = st128::write_agreement(buffer, 9,
                                             {.method = LinkMethod::SharedMemory,
                                              .byte_order = descriptor::ByteOrder::Big,
                                              .kind = LinkKind::Queued,
                                              .depth = 0x102,
                                              .producer_period = Duration{3},
                                              .consumer_period = Duration{4},
                                              .fields = {{"AB", Type::Float, 5}},
                                              .wakes = true});
  ASSERT_TRUE(octets);
  // link, method, order, kind, depth, wakes, two periods, number of fields, then name_length, name, type, count
  const std::vector<unsigned char> as_written{9, 1, 2, 2, 1, 2, 1, 0, 0, 0,   0,   0, 0, 0, 3, 0,
                                              0, 0, 0, 0, 0, 0, 4, 1, 2, 'A', 'B', 9, 0, 0, 0, 5};
  ASSERT_EQ(*octets, as_written.size());
  EXPECT_EQ(std::memcmp(buffer.data(), as_written.data(), *octets), 0);
  expect_octets("field", {{"name_length", {0, 1}}, {"name", {1, 0}}});
}

TEST(InterfacePages, States) {
  std::map<std::uint64_t, std::string> states;
  for (const auto& row : EnumTexts<State>::table) states[of(row.value)] = row.text;
  expect_numbers("states", states);
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::string> page, code;
  for (const Row& row : table("numbers: ways")) page[{number_of(row[0]), number_of(row.at(1))}] = row.at(2);
  for (const auto& from : EnumTexts<State>::table)
    for (const auto& to : EnumTexts<State>::table) {
      const auto way = route(from.value, to.value);
      if (!way) continue;
      std::string text;
      for (std::size_t i = 0; i < way->size; ++i) text += (i == 0 ? "" : " ") + std::to_string(of(way->states[i]));
      code[{of(from.value), of(to.value)}] = text;
    }
  EXPECT_EQ(page, code);
}

TEST(InterfacePages, Devices) {
  expect_octets("device frame", {{"magic", {0, 2}},
                                 {"kind", {2, 1}},
                                 {"mode", {3, 1}},
                                 {"epoch", {4, 4}},
                                 {"sequence", {8, 4}},
                                 {"flags", {12, 2}},
                                 {"payload_octets", {14, 2}},
                                 {"watchdog_us", {16, 4}},
                                 {"payload", {20, 0}}});
  std::array<std::byte, 64> buffer{};
  const std::array payload{std::byte{0xAA}};
  const auto expect_frame = [&](Octets frame, const std::vector<unsigned char>& expected) {
    ASSERT_EQ(frame.size(), expected.size() + 2);
    EXPECT_EQ(std::memcmp(frame.data(), expected.data(), expected.size()), 0);
  };
  expect_frame(write_command(buffer, {.mode = DeviceMode::Stop,
                                      .epoch = 0x04030201,
                                      .sequence = 0x08070605,
                                      .watchdog_us = 0x0D0C0B0A,
                                      .payload = payload})
                   .value(),
               {0x44, 0x48, 1, 2, 1, 2, 3, 4, 5, 6, 7, 8, 0, 0, 1, 0, 0x0A, 0x0B, 0x0C, 0x0D, 0xAA});
  expect_frame(
      write_status(buffer, {.epoch = 0x04030201, .sequence = 0x08070605, .flags = 0x0B0A, .payload = {}}).value(),
      {0x44, 0x48, 2, 0, 1, 2, 3, 4, 5, 6, 7, 8, 0x0A, 0x0B, 0, 0, 0, 0, 0, 0});
  expect_numbers("device modes",
                 {{of(DeviceMode::Off), "Off"}, {of(DeviceMode::Active), "Active"}, {of(DeviceMode::Stop), "Stop"}});
  expect_numbers("device flags", {{device_flag::watchdog_tripped, "watchdog_tripped"},
                                  {device_flag::old_epoch_refused, "old_epoch_refused"},
                                  {device_flag::over_temperature, "over_temperature"},
                                  {device_flag::torque_saturated, "torque_saturated"}});
  EXPECT_EQ(max_device_payload_octets, 1002U);
  expect_octets("enable frame", {{"magic", {0, 2}},
                                 {"kind", {2, 1}},
                                 {"enabled_or_output", {3, 1}},
                                 {"flags", {4, 2}},
                                 {"epoch", {6, 4}},
                                 {"sequence", {10, 4}},
                                 {"error_control", {14, 2}}});
  expect_frame(write_enable_command(buffer, {.enabled = 1, .epoch = 0x04030201, .sequence = 0x08070605}).value(),
               {0x45, 0x48, 0x33, 1, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8});
  expect_frame(
      write_enable_status(
          buffer, {.output = DeviceOutput::Holding, .flags = 0x0B0A, .epoch = 0x04030201, .sequence = 0x08070605})
          .value(),
      {0x45, 0x48, 0x4C, 3, 0x0A, 0x0B, 1, 2, 3, 4, 5, 6, 7, 8});
  expect_octets("power frame", {{"magic", {0, 2}},
                                {"kind", {2, 1}},
                                {"on", {3, 1}},
                                {"off_after", {4, 2}},
                                {"sequence", {6, 4}},
                                {"error_control", {10, 2}}});
  using std::chrono_literals::operator""ms;
  expect_frame(write_power_command(buffer, {.on = true, .off_after = 0x0203ms, .sequence = 0x08070605}).value(),
               {0x50, 0x48, 0x96, 1, 3, 2, 5, 6, 7, 8});
  expect_frame(write_power_status(buffer, {.on = false, .sequence = 0x08070605}).value(),
               {0x50, 0x48, 0xE9, 0, 0, 0, 5, 6, 7, 8});
}

TEST(InterfacePages, FramesInAStream) {
  expect_octets(
      "streamed device frame",
      {{"sync", {0, 2}}, {"frame_octets", {2, 2}}, {"head_control", {4, 2}}, {"frame", {stream_head_octets, 0}}});
  std::array<std::byte, 64> buffer;
  const Octets streamed = write_streamed(buffer, std::array{std::byte{0xDE}, std::byte{0xAD}});
  // Check sums by Python's binascii.crc_hqx.
  const std::array<unsigned, 10> expected{0x48, 0x53, 2, 0, 0x63, 0x0E, 0xDE, 0xAD, 0x60, 0x4F};
  ASSERT_EQ(streamed.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(std::to_integer<unsigned>(streamed[i]), expected[i]) << i;
}

/// Of the memory itself: how it is laid out stands in the flow's source only.
TEST(InterfacePages, SharedMemoryFlows) {
  expect_octets("shared memory flow", {{"magic", {0, 8}}, {"opened", {64, 8}}, {"mailbox", {128, 1152}}});
  expect_octets(
      "mailbox",
      {{"sequence", {0, 8}}, {"octets", {8, 8}}, {"words", {16, 1024}}, {"bell", {1088, 4}}, {"waiting", {1092, 4}}});
  const std::string address = "interface-page-" + std::to_string(::getpid());
  auto subsystem = SharedMemoryFlow::open(address, FlowSide::Subsystem).value();
  auto device = SharedMemoryFlow::open(address, FlowSide::Device).value();
  const std::string folder = "/dev/shm/hirosco/" + address;
  const int file = ::open((folder + "/frames").c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_GE(file, 0);
  struct stat status{};
  ASSERT_EQ(::fstat(file, &status), 0);
  EXPECT_EQ(status.st_size, 2432);
  const auto* const memory = static_cast<const unsigned char*>(::mmap(nullptr, 2432, PROT_READ, MAP_SHARED, file, 0));
  ASSERT_NE(static_cast<const void*>(memory), MAP_FAILED);
  const auto u64 = [memory](std::size_t at) {
    std::uint64_t word;
    std::memcpy(&word, memory + at, sizeof word);
    return word;
  };
  EXPECT_EQ(u64(0), 0x0001'574F'4C46'5348U);
  EXPECT_EQ(u64(64) % 2, 1U) << "the subsystem's side is open";
  EXPECT_EQ(u64(72) % 2, 1U) << "the device's";
  const std::array to_device{std::byte{1}, std::byte{2}, std::byte{3}};
  const std::array to_subsystem{std::byte{4}};
  ASSERT_TRUE(subsystem->send(to_device));
  ASSERT_TRUE(device->send(to_subsystem));
  for (const auto& [mailbox, octets, word] : {std::array<std::uint64_t, 3>{1280, 3, 0x030201}, {128, 1, 4}}) {
    EXPECT_EQ(u64(mailbox), 2U);
    EXPECT_EQ(u64(mailbox + 8), octets);
    EXPECT_EQ(u64(mailbox + 16), word);
    EXPECT_EQ(u64(mailbox + 1088), 1U) << "rung once, nobody waits";
  }
  ::munmap(const_cast<unsigned char*>(memory), 2432);
  ::close(file);
  subsystem.reset();
  device.reset();
  EXPECT_EQ(::rmdir(folder.c_str()), 0) << "it stays, and is empty";
}

TEST(InterfacePages, Streams) {
  expect_octets("stream frame", {{"magic", {0, 2}},
                                 {"version", {2, 1}},
                                 {"kind", {3, 1}},
                                 {"payload_octets", {4, 2}},
                                 {"payload", {stream_frame_head_octets, 0}}});
  std::array<std::byte, 16> buffer{};
  const auto frame = write_stream_frame(buffer, StreamFrameKind::Permit, std::array{std::byte{0xAA}}).value();
  const std::array<unsigned char, 7> expected{0x48, 0x4D, stream_frame_version, 3, 0, 1, 0xAA};
  ASSERT_EQ(frame.size(), 9U);
  EXPECT_EQ(std::memcmp(frame.data(), expected.data(), expected.size()), 0);
  EXPECT_EQ(max_stream_frame_payload, 4104U);
  expect_numbers("stream frames", {{1, "Message"}, {2, "Vital"}, {3, "Permit"}});
  VitalPage vital;
  PermitPage permit;
  MemberWords member{vital, permit};
  SupervisorWords supervisor{vital, permit};
  const auto end_of = [](const Table& rows) { return number_of(rows.back()[0]) + number_of(rows.back()[1]); };
  const auto told = [](StreamWords& words) {
    std::array<std::byte, StreamWords::max_octets> room;
    OctetWriter writer{room};
    words.tell(writer);
    return writer.size();
  };
  EXPECT_EQ(told(member), end_of(table("octets: vital words")));
  EXPECT_EQ(told(supervisor), end_of(table("octets: permit words")));
  EXPECT_EQ(member.urgent_octets(), 24U);
  EXPECT_EQ(supervisor.urgent_octets(), 24U);
  // Each word in its place: what is written there alone differs there alone.
  vital.missed = 0xAB;
  std::array<std::byte, StreamWords::max_octets> room;
  OctetWriter writer{room};
  member.tell(writer);
  for (const Row& row : table("octets: vital words"))
    EXPECT_TRUE(row.at(2) != "missed" || room[number_of(row[0]) + 7] == std::byte{0xAB});
}

/// Last: no table stands there that nobody compares.
TEST(InterfacePagesAll, AreCompared) {
  for (const auto& [mark, rows] : tables()) {
    EXPECT_FALSE(rows.empty()) << mark;
    EXPECT_NE(std::ranges::find(compared(), mark), compared().end()) << mark << " is compared with nothing";
  }
}

}  // namespace
}  // namespace hirosco
