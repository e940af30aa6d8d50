// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace hirosco::pus
