// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// A ground station pings a subsystem: telecommand, acceptance, service, telemetry - without any I/O.
#include <array>
#include <cstdio>

#include "hirosco/pus/packet/packet_counters.hpp"
#include "hirosco/pus/st17_test/test_service.hpp"

using namespace hirosco;

// [stamper]
/// Turns the reports of services into packets of APID 10.
class Downlink final : public pus::TelemetrySink {
 public:
  void report(std::uint8_t service, std::uint8_t subtype, std::uint16_t destination, Octets data) override {
    pus::TelemetryHeader header{.apid = 10, .service = service, .subtype = subtype, .destination = destination};
    counters_.stamp(header);
    std::array<std::byte, pus::max_telemetry_octets> buffer;
    const auto packet = pus::write_telemetry(buffer, header, data);
    if (packet)
      std::printf("TM[%d,%d] packet %d, %zu octets\n", service, subtype, header.sequence_count, packet->size());
  }

 private:
  pus::CounterBlock block_{};
  pus::PacketCounters counters_{block_};
};
// [stamper]

/// There is nothing here that could test itself.
class NoSelfTest final : public pus::SelfTest {
  std::expected<void, pus::FailureNotice> begin_self_test(const pus::Request&) override {
    return std::unexpected{pus::FailureNotice{pus::FailureCode::NotPermittedNow}.with(std::uint8_t{0})};
  }
  [[nodiscard]] pus::SelfTestRecord newest_self_test() const override { return {}; }
};

int main() {
  // [ping]
  std::array<std::byte, 64> buffer;
  const auto packet =
      pus::write_telecommand(buffer, {.apid = 10, .ack = pus::ack_all, .service = 17, .subtype = 1}, {});
  const auto telecommand = pus::TelecommandView::parse(packet.value());

  Downlink downlink;
  pus::Verification verification{downlink};
  NoSelfTest self_test;
  pus::TestService service{verification, downlink, self_test};
  service.handle(telecommand.value(), pus::request_of(telecommand.value()));
  // [ping]
}
