// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/pus/testing/recording_sink.hpp"

/// ST[03] of a small subsystem whose cycle the test plays.
namespace hirosco::pus::testing {

using descriptor::HousekeepingStructure;
using descriptor::ParameterRef;

inline descriptor::Field named(const char* name, Type type) {
  descriptor::Field field;
  field.name = name;
  field.type = type;
  return field;
}

/// The paper's Listing 1, in subsystem 2.
inline descriptor::SubsystemDescriptor listing_1() {
  descriptor::SubsystemDescriptor subsystem;
  subsystem.id = 2;
  descriptor::Parameter current;
  current.field = named("CUR_VALUES", Type::Struct);
  current.members = {{named("STATE", Type::Int32), 0}, {named("POSITION", Type::Double), 0}};
  descriptor::Parameter desired;
  desired.field = named("DES_POSITION", Type::Double);
  desired.id = 1;
  subsystem.parameters = {current, desired};
  return subsystem;
}
constexpr const char* cur_values = "00022000";
constexpr const char* state_member = "00020600";
constexpr const char* des_position = "00020a01";

/// The paper's Listing 2.
inline HousekeepingStructure listing_2(std::uint16_t id = 4711, std::uint32_t interval = 500,
                                       std::uint16_t repetitions = 5) {
  HousekeepingStructure structure;
  structure.id = id;
  structure.interval_cycles = interval;
  structure.sampled_once = {{"CUR_VALUES", 0, {}, {}}};
  structure.sampled_repeatedly = {{repetitions, {{"DES_POSITION", 1, {}, {}}}}};
  return structure;
}

/// STATE is the cycle, POSITION half and DES_POSITION twice the cycle, so that a report tells when it was sampled.
struct Cycle final : SampleSource, SampleSink {
  explicit Cycle(HousekeepingSampler& to_tick) : sampler{to_tick} {}
  std::size_t sample(std::uint16_t parameter, int member, MutableOctets to) noexcept override {
    if (broken) return 0;
    OctetWriter writer{to};
    if (parameter == 0 && member != 1) writer.put(static_cast<std::int32_t>(cycle));
    if (parameter == 0 && member != 0) writer.put(0.5 * cycle);
    if (parameter == 1) writer.put(2.0 * cycle);
    return writer.size();
  }
  MutableOctets reserve(std::size_t octets) noexcept override {
    return full ? MutableOctets{} : MutableOctets{buffer}.first(octets);
  }
  void commit(std::uint16_t structure, std::size_t octets) noexcept override {
    reports.push_back({cycle, structure, Bytes(buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(octets))});
  }
  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      ++cycle;
      sampler.tick(*this, *this);
    }
  }
  [[nodiscard]] std::vector<int> take_cycles() {
    std::vector<int> cycles;
    for (const auto& report : reports) cycles.push_back(report.cycle);
    reports.clear();
    return cycles;
  }
  struct Sampled {
    int cycle;
    std::uint16_t structure;
    Bytes data;
  };
  HousekeepingSampler& sampler;
  int cycle{0};
  bool full{false};
  bool broken{false};
  Bytes buffer = Bytes(max_housekeeping_octets);
  std::vector<Sampled> reports;
};

struct Housekeeping : ::testing::Test {
  descriptor::SubsystemDescriptor subsystem{listing_1()};
  HousekeepingSampler sampler;
  Cycle cycle{sampler};
  RecordingSink sink;
  Verification verification{sink};
  HousekeepingService service{subsystem, sampler, verification, sink};

  void load(const HousekeepingStructure& structure) { ASSERT_TRUE(service.load(std::span{&structure, 1}).has_value()); }
  /// Sends with no success reports asked for, and gives what came back: nothing when all is well.
  std::vector<std::string> ask(std::uint8_t subtype, const std::string& hex) {
    send(service, subtype, hex, 0);
    return sink.take();
  }
};

}  // namespace hirosco::pus::testing
