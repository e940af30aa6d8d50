// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include "supervisor/supervision/data_handling/retrieval.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

/// CAMERA is the ground link; its ground asks under 7, another one under 8.
namespace hirosco::supervisor::testing {

namespace st129 = pus::st129;
using enum descriptor::State;

struct RetrievalTest : PartsTest {
  static constexpr std::uint16_t ground = 7, other_ground = 8;
  static constexpr OnboardTime never_before{}, always_after{std::chrono::hours{24 * 365 * 100}};
  struct Down {
    std::vector<std::uint64_t> numbers;
    std::vector<std::vector<std::byte>> packets;
    std::vector<st129::RetrievalEnd> ends;
    std::vector<std::string> verdicts;  ///< "1.7 of 3", its code behind it where there is one
    std::size_t most_at_once{0};  ///< in one watch period
  };
  std::uint16_t count{0};

  void SetUp() override {
    PartsTest::SetUp();
    start_all(Operational);
    parts.own.start(craft.mode_epoch);
    own_step();
    static_cast<void>(listen());
  }
  /// Said while nobody listens, as the log has it.
  void say_unheard(int times, std::uint8_t service = 17, std::uint8_t subtype = 2) {
    set(camera, Offline);
    for (int i = 0; i < times; ++i) {
      wait(1ms);
      report(arm, service, subtype, std::array{std::byte{0x12}, static_cast<std::byte>(i)});
    }
    parts.telemetry.serve_ground();  // nobody is there
    set(camera, Operational);
  }
  void ask(const st129::Retrieve& wanted, std::uint16_t who = ground) { ask_with(st129::write_retrieve(wanted), who); }
  void ask_with(Octets data, std::uint16_t who = ground, MessageKind kind = MessageKind::GroundTelecommand,
                std::uint16_t by = camera) {
    std::array<std::byte, pus::max_telecommand_octets> buffer;
    const auto packet = pus::write_telecommand(buffer,
                                               {.apid = supervisor_apid,
                                                .sequence_count = count++,
                                                .ack = pus::ack_completion,
                                                .service = st129::service_type,
                                                .subtype = st129::retrieve,
                                                .source = who},
                                               data);
    EXPECT_TRUE(played[by].channel.subsystem_end().send({.kind = kind, .link = 5, .packet = *packet}));
    parts.reception.read(*craft.member(by));
    own_step();
  }
  /// What the ground link was given since it was asked last.
  Down listen() {
    Down down;
    parts.telemetry.serve_ground();
    MessageBuffer buffer;
    for (;;) {
      const auto next = played[camera].channel.subsystem_end().receive(buffer);
      if (!next || next->flow == Flow::None) return down;
      const auto heard = pus::TelemetryView::parse(next->message.packet);
      if (!heard || heard->apid() != supervisor_apid) continue;
      const Octets data = heard->source_data();
      if (heard->service() == 1) {
        OctetReader reader{data};
        std::string text =
            fmt::format("1.{} of {}", heard->subtype(), reader.get<std::uint32_t>() % pus::sequence_counts);
        if (heard->subtype() % 2 == 0) text += fmt::format(" {}", reader.get<std::uint16_t>());
        down.verdicts.push_back(text);
      }
      if (heard->service() != st129::service_type) continue;
      if (const auto end = st129::read_retrieval_end(data); end && heard->subtype() == st129::retrieval_end)
        down.ends.push_back(*end);
      if (!st129::is_retrieved(*heard)) continue;
      const auto again = st129::read_retrieved(data);
      down.numbers.push_back(again->number);
      down.packets.emplace_back(again->packet.begin(), again->packet.end());
    }
  }
  /// So many watch periods.
  Down go_on(int periods = 100) {
    Down all;
    for (int i = 0; i < periods; ++i) {
      wait(10ms);
      parts.retrieval.watch(clock.now());
      own_step();
      Down now = listen();
      all.most_at_once = std::max(all.most_at_once, now.numbers.size());
      std::ranges::copy(now.numbers, std::back_inserter(all.numbers));
      std::ranges::move(now.packets, std::back_inserter(all.packets));
      std::ranges::move(now.ends, std::back_inserter(all.ends));
      std::ranges::move(now.verdicts, std::back_inserter(all.verdicts));
    }
    return all;
  }
  std::vector<LogRecord> logged() { return store->read({.last = 100'000, .end = LogEnd::Oldest})->records; }
};

}  // namespace hirosco::supervisor::testing
