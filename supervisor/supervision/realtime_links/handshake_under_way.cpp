// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/realtime_links/handshake_under_way.hpp"

namespace hirosco::supervisor {

namespace st128 = pus::st128;

std::string terms_text(const st128::Agreement& agreement) {
  const auto hertz = [](Duration period) { return std::to_string(std::chrono::nanoseconds{1s} / period) + " Hz"; };
  return std::string{to_text(agreement.method)} + ", " + std::string{to_text(agreement.byte_order)} + " endian, " +
         std::string{to_text(agreement.kind)} + ", " + hertz(agreement.producer_period) + " to " +
         hertz(agreement.consumer_period) + ", " + std::to_string(agreement.payload_octets()) + " octets" +
         (agreement.depth == 0 ? "" : ", " + std::to_string(agreement.depth) + " samples deep") +
         (agreement.wakes ? ", each starts a cycle" : "");
}

bool HandshakeUnderWay::awaits(std::uint16_t apid, std::uint8_t subtype) const noexcept {
  switch (stage) {
    case Stage::AwaitOffer: return subtype == st128::request_offer && apid == consumer;
    case Stage::AwaitAgreement: return subtype == st128::negotiate_terms && apid == producer;
    case Stage::AwaitProducer: return subtype == st128::attach && apid == producer;
    case Stage::AwaitConsumer: return subtype == st128::attach && apid == consumer;
    case Stage::AwaitReached: return subtype == st128::reach && apid == producer;
  }
  return false;
}

Result<std::size_t> HandshakeUnderWay::write_attach(MutableOctets buffer, st128::Role role) const {
  return st128::write_attach_request(buffer, {.link = link->id,
                                              .role = role,
                                              .epoch = epoch,
                                              .set = role == st128::Role::Producer ? link->provides : link->requires_,
                                              .agreement = agreement,
                                              .route = route,
                                              .made = made == epoch ? 0 : made});
}

std::string HandshakeUnderWay::terms() const {
  return terms_text(agreement) + (route.producer.empty() ? "" : ", " + route.producer + " to " + route.consumer);
}

}  // namespace hirosco::supervisor
