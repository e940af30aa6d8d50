// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"

namespace hirosco::pus {
namespace {

/// Counts reports and checks that each has the octets of its structure, whatever was there before in its slot.
struct Checker final : SampleSource, SampleSink {
  std::size_t sample(std::uint16_t, int, MutableOctets to) noexcept override {
    for (auto& octet : to) octet = std::byte{0xAB};
    return to.size();
  }
  MutableOctets reserve(std::size_t octets) noexcept override { return MutableOctets{room}.first(octets); }
  void commit(std::uint16_t structure, std::size_t octets) noexcept override {
    ++reports;
    if (octets != 2U + structure % 7 + 1) ++wrong;
    for (std::size_t i = 2; i < octets; ++i)
      if (room[i] != std::byte{0xAB}) ++wrong;
  }
  std::array<std::byte, max_housekeeping_octets> room{};
  std::uint64_t reports{0};
  std::uint64_t wrong{0};
};

struct Silent final : TelemetrySink {
  void report(std::uint8_t, std::uint8_t, std::uint16_t, Octets) override {}
};

void send_octets(HousekeepingService& service, std::uint8_t subtype, Octets data) {
  std::array<std::byte, 64> buffer;
  const auto packet = write_telecommand(buffer, {.apid = 10, .ack = 0, .service = 3, .subtype = subtype}, data);
  const auto view = TelecommandView::parse(packet.value());
  service.handle(view.value(), request_of(view.value()));
}

/// N = 1 and the structure id.
void send_for(HousekeepingService& service, std::uint8_t subtype, std::uint16_t id) {
  std::array<std::byte, 3> data;
  OctetWriter{data}.put(std::uint8_t{1}).put(id);
  send_octets(service, subtype, data);
}

void create(HousekeepingService& service, std::uint16_t id) {
  std::array<std::byte, 12> data;
  OctetWriter writer{data};
  writer.put(id).put(std::uint32_t{1}).put(std::uint8_t{1});
  writer.put(ParameterId{2, Type::Uint8, static_cast<std::uint8_t>(id % 7)}.wire()).put(std::uint8_t{0});
  send_octets(service, HousekeepingService::create_structure, writer.written());
}

TEST(HousekeepingHandOver, KeepsEveryReportWholeWhileStructuresComeAndGo) {
  descriptor::SubsystemDescriptor subsystem;
  subsystem.id = 2;
  for (std::uint8_t i = 0; i < 7; ++i) {
    auto& parameter = subsystem.parameters.emplace_back();
    parameter.field.type = Type::Uint8;
    parameter.field.count = static_cast<std::uint16_t>(i + 1);
    parameter.id = i;
  }
  HousekeepingSampler sampler;
  Silent sink;
  Verification verification{sink};
  HousekeepingService service{subsystem, sampler, verification, sink};
  auto checker = std::make_unique<Checker>();
  std::atomic<bool> stop{false};
  std::atomic<std::uint64_t> ticks{0};
  std::thread cycle{[&] {
    while (!stop.load()) {
      sampler.tick(*checker, *checker);
      ++ticks;
      std::this_thread::yield();
    }
  }};
  for (std::uint16_t id = 1; id <= 4'000; ++id) {
    // Now and then lets the cycle catch up, or a busy machine would never run it before the last deletion.
    if (id % 16 == 0)
      for (const auto seen = ticks.load(); ticks.load() < seen + 2;) std::this_thread::yield();
    create(service, id);
    send_for(service, HousekeepingService::enable_periodic, id);
    send_for(service, HousekeepingService::one_shot, id);
    if (id <= 10) continue;
    const auto old = static_cast<std::uint16_t>(id - 10);
    send_for(service, HousekeepingService::disable_periodic, old);
    send_for(service, HousekeepingService::delete_structures, old);
  }
  stop.store(true);
  cycle.join();
  sampler.tick(*checker, *checker);
  EXPECT_GT(checker->reports, 0U);
  EXPECT_EQ(checker->wrong, 0U);
  EXPECT_EQ(sampler.failed_samples(), 0U);
}

}  // namespace
}  // namespace hirosco::pus
