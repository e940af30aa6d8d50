// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "hirosco/data_transfer/memory/heap_memory.hpp"
#include "supervisor/supervision/realtime_links/link_handshakes.hpp"
#include "supervisor/supervision/testing/small_mission.hpp"

namespace hirosco::supervisor::testing {

/// Writes down what link handling does: "11<-1" is TC[128,1] to subsystem 11, "+" behind it memory beside the packet.
struct LinkWitness final : LinkOperator {
  void send_link_command(std::uint16_t apid, std::uint8_t subtype, Octets data, const MemoryHandle& memory) override {
    sent.push_back(std::to_string(apid) + "<-" + std::to_string(subtype) + (memory ? "+" : ""));
    last.assign(data.begin(), data.end());
    if (memory) last_memory = memory;
  }
  void link_changed(const descriptor::MissionLink& link, bool up, const std::string& text) override {
    changes.push_back(std::to_string(link.id) + (up ? " up: " : " down: ") + text);
  }
  std::vector<std::string> take() { return std::exchange(sent, {}); }
  std::vector<std::string> sent;
  std::vector<std::string> changes;
  std::vector<std::byte> last;
  MemoryHandle last_memory;
};

/// A handshake and whoever answers it. Link 2 goes from HAND (11, producer) to ARM (10, consumer); the test speaks for both.
struct LinkHandshakesTest : ::testing::Test {
  descriptor::Mission mission = testing::small_mission();
  HeapMemory memory;
  LinkWitness supervisor;
  LinkGraph graph{mission};
  LinkHandshakes links{mission, graph, memory, standard_link_mechanisms(), supervisor};
  std::vector<bool> ends;
  std::vector<LinkReleases::Released> released;
  TimePoint now{};
  pus::st128::Offer offer{
      .set = "HAND_STATE", .period = 1ms, .terms = {}, .depth = 0, .fields = {{"ANGLE", Type::Double, 2}}};
  pus::st128::Agreement agreement{
      LinkMethod::SharedMemory,    descriptor::ByteOrder::Little, LinkKind::Latest, 0, 500us, 1ms,
      {{"ANGLE", Type::Double, 2}}};

  LinkHandshakes::Done done() {
    return [this](bool success) { ends.push_back(success); };
  }
  LinkReleases::Done on_release() {
    return [this](LinkReleases::Released how) { released.push_back(how); };
  }
  void report(std::uint16_t from, std::uint8_t subtype, Octets data) {
    std::array<std::byte, 4096> buffer{};
    const auto packet = pus::write_telemetry(buffer, {.apid = from, .service = 128, .subtype = subtype}, data);
    links.handle(from, pus::TelemetryView::parse(packet.value()).value());
  }
  template <class Write, class Value>
  void say(std::uint16_t from, std::uint8_t subtype, Write write, const Value& value, std::uint8_t link = 2) {
    std::array<std::byte, 4096> buffer{};
    const auto octets = write(MutableOctets{buffer}, link, value);
    report(from, subtype, Octets{buffer}.first(octets.value()));
  }
  void offers(std::uint16_t from = arm) { say(from, pus::st128::offer, pus::st128::write_offer, offer); }
  void agrees(std::uint16_t from = hand) { say(from, pus::st128::agreement, pus::st128::write_agreement, agreement); }
  void refuses(std::uint16_t from) {
    say(from, pus::st128::refusal, pus::st128::write_refusal, pus::st128::Refusal{4, "no such field"});
  }
  void says(std::uint16_t from, std::uint8_t subtype, pus::st128::Role role, std::uint8_t link = 2) {
    report(from, subtype, std::array{std::byte{link}, static_cast<std::byte>(role)});
  }
  void attaches(std::uint16_t from, pus::st128::Role role, const LinkRoute& route = {.link = 2}) {
    std::array<std::byte, 512> buffer{};
    const auto octets = pus::st128::write_attached(buffer, {.role = role, .route = route});
    report(from, pus::st128::attached, Octets{buffer}.first(octets.value()));
  }
  void detaches(std::uint16_t from, pus::st128::Role role) { says(from, pus::st128::detached, role); }

  /// Handshake up to and including a stage: 0 asked, 1 offered, 2 agreed, 3 producer attached, 4 up.
  void advance(int stage) {
    ASSERT_TRUE(links.establish(2, now, done()));
    if (stage > 0) offers();
    if (stage > 1) agrees();
    if (stage > 2) attaches(hand, pus::st128::Role::Producer);
    if (stage > 3) attaches(arm, pus::st128::Role::Consumer);
  }
};

}  // namespace hirosco::supervisor::testing
