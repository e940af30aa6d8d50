// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"
#include "hirosco/pus/testing/recording_sink.hpp"
#include "hirosco/utilities/allocation_guard.hpp"

namespace hirosco::pus {
namespace {
using namespace testing;

struct Memory final : SampleSource, SampleSink {
  std::size_t sample(std::uint16_t, int, MutableOctets to) noexcept override { return to.size(); }
  MutableOctets reserve(std::size_t octets) noexcept override { return MutableOctets{room}.first(octets); }
  void commit(std::uint16_t, std::size_t) noexcept override { ++reports; }
  std::array<std::byte, max_housekeeping_octets> room{};
  int reports{0};
};

TEST(HousekeepingCycle, NeverUsesTheHeapWhateverTheServiceAsksOfIt) {
  descriptor::SubsystemDescriptor subsystem;
  subsystem.id = 2;
  subsystem.parameters.emplace_back().field.type = Type::Uint8;
  HousekeepingSampler sampler;
  RecordingSink sink;
  Verification verification{sink};
  HousekeepingService service{subsystem, sampler, verification, sink};
  auto memory = std::make_unique<Memory>();
  ASSERT_TRUE(RealtimeScope::hook_present());
  const auto run = [&] {
    const RealtimeScope scope;
    for (int i = 0; i < 10; ++i) sampler.tick(*memory, *memory);
    return scope.count();
  };
  const std::pair<std::uint8_t, const char*> requests[] = {{1,
                                                            "0001"
                                                            "00000002"
                                                            "00"
                                                            "01"
                                                            "0002"
                                                            "01"
                                                            "00020100"},   // create
                                                           {1,
                                                            "0002"
                                                            "00000001"
                                                            "01"
                                                            "00020100"
                                                            "00"},
                                                           {5,
                                                            "020001"
                                                            "0002"},
                                                           {27, "010001"},
                                                           {31,
                                                            "01"
                                                            "0001"
                                                            "00000004"},
                                                           {6, "010002"},
                                                           {3, "010002"}};
  for (const auto& [subtype, hex] : requests) {
    send(service, subtype, hex, 0);
    EXPECT_EQ(run(), AllocationCount{}) << int{subtype};
  }
  EXPECT_TRUE(sink.reports.empty()) << sink.reports.front().text();
  EXPECT_GT(memory->reports, 20);
}

struct Unheard final : TelemetrySink {
  void report(std::uint8_t, std::uint8_t subtype, std::uint16_t, Octets data) override {
    ++reports;
    if (subtype == HousekeepingService::structure_report) longest_octets = std::max(longest_octets, data.size());
  }
  std::uint64_t reports{0};
  std::size_t longest_octets{0};
};

/// A thousand values of four types.
descriptor::SubsystemDescriptor with_a_thousand_values() {
  descriptor::SubsystemDescriptor subsystem;
  subsystem.id = 2;
  for (const Type type : {Type::Uint8, Type::Int8, Type::Uint16, Type::Int16})
    for (std::uint8_t id = 0; id < 250; ++id) {
      auto& parameter = subsystem.parameters.emplace_back();
      parameter.field.type = type;
      parameter.id = id;
    }
  return subsystem;
}

Bytes telecommand(std::uint8_t subtype, Octets data) {
  Bytes buffer(max_telecommand_octets);
  const auto packet =
      write_telecommand(buffer, {.apid = 2, .ack = ack_all, .service = 3, .subtype = subtype, .source = 7}, data);
  return {packet->begin(), packet->end()};
}

void put_values(OctetWriter& writer, Type type) {
  writer.put(std::uint8_t{250});
  for (std::uint8_t id = 0; id < 250; ++id) writer.put(ParameterId{2, type, id}.wire());
}

/// TC[3,1]: 250 values once, and two sets of as many.
Bytes creation_of(std::uint16_t id) {
  Bytes data(max_telecommand_octets);
  OctetWriter writer{data};
  writer.put(id).put(std::uint32_t{1});
  put_values(writer, Type::Uint8);
  writer.put(std::uint8_t{2});
  for (const Type type : {Type::Int8, Type::Uint16}) put_values(writer.put(std::uint16_t{1}), type);
  return telecommand(HousekeepingService::create_structure, writer.written());
}

/// TC[3,29]: one more set.
Bytes addition_to(std::uint16_t id) {
  Bytes data(max_telecommand_octets);
  OctetWriter writer{data};
  writer.put(id).put(std::uint8_t{0}).put(std::uint8_t{1}).put(std::uint16_t{1});
  put_values(writer, Type::Int16);
  return telecommand(HousekeepingService::append_parameters, writer.written());
}

Bytes to_structure(std::uint8_t subtype, std::uint16_t id) {
  std::array<std::byte, 3> data{};
  OctetWriter{data}.put(std::uint8_t{1}).put(id);
  return telecommand(subtype, data);
}

TEST(HousekeepingService, NeverUsesTheHeapForTheLongestStructuresThatComeAndGo) {
  const descriptor::SubsystemDescriptor subsystem = with_a_thousand_values();
  HousekeepingSampler sampler;
  Unheard sink;
  Verification verification{sink};
  HousekeepingService service{subsystem, sampler, verification, sink};
  using Service = HousekeepingService;
  std::vector<Bytes> packets;
  for (std::uint16_t id = 1; id <= max_housekeeping_structures + 1; ++id)  // the last finds no room
    packets.push_back(creation_of(id));
  for (std::uint16_t id = 1; id <= max_housekeeping_structures; ++id) {
    // To lengthen one takes a free place beside that of the shorter.
    if (id == 1) packets.push_back(to_structure(Service::delete_structures, max_housekeeping_structures));
    packets.push_back(addition_to(id));
    for (const std::uint8_t subtype :
         {Service::report_structures, Service::enable_periodic, Service::one_shot, Service::disable_periodic,
          Service::report_properties, Service::delete_structures})
      packets.push_back(to_structure(subtype, id));
  }
  const auto all = [&] {
    for (const Bytes& packet : packets) {
      const auto view = TelecommandView::parse(packet);
      service.handle(*view, request_of(*view));
      sampler.apply_commands();
    }
  };
  for (int round = 0; round < 3; ++round) {
    const RealtimeScope scope;
    all();
    EXPECT_EQ(scope.count(), AllocationCount{}) << "round " << round;
  }
  EXPECT_GT(sink.reports, 0U);
  // ECSS-E-ST-70-41C 8.3.2.10: the fields, a thousand ids, and of each set its repetitions and how many it has.
  EXPECT_EQ(sink.longest_octets, 2U + 1 + 4 + 1 + 1 + 4 * 1'000 + 3 * (2 + 1));
}

}  // namespace
}  // namespace hirosco::pus
