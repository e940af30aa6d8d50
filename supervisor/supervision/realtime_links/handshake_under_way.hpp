// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "hirosco/data_transfer/link/link.hpp"
#include "hirosco/data_transfer/memory/memory.hpp"
#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/pus/st128_realtime_link/link_handshake.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco::supervisor {

/// One handshake: whom it is between, how far it has come, and what is agreed so far.
struct HandshakeUnderWay {
  enum class Stage : std::uint8_t { AwaitOffer, AwaitAgreement, AwaitProducer, AwaitConsumer, AwaitReached };

  const descriptor::MissionLink* link{};
  std::uint16_t producer{};
  std::uint16_t consumer{};
  Stage stage{Stage::AwaitOffer};
  TimePoint deadline{};
  std::string failure{};  ///< why it ends before its deadline
  std::uint32_t epoch{};
  std::uint32_t made{};  ///< epoch for which the memory was made
  pus::st128::Agreement agreement;
  MemoryHandle shared;  ///< by both ends
  LinkRoute route;  ///< as far as it is known, of a link that is not memory
  std::function<void(bool success)> done;

  [[nodiscard]] bool is_between(std::uint16_t apid) const noexcept { return apid == producer || apid == consumer; }
  /// TC[128,subtype] to this end is what its stage waits for an answer to.
  [[nodiscard]] bool awaits(std::uint16_t apid, std::uint8_t subtype) const noexcept;
  /// Data of TC[128,3] to this end; how many octets they are.
  [[nodiscard]] Result<std::size_t> write_attach(MutableOctets buffer, pus::st128::Role role) const;
  /// What its ends have agreed on, in words.
  [[nodiscard]] std::string terms() const;
};

/// The same, of an agreement alone.
[[nodiscard]] std::string terms_text(const pus::st128::Agreement& agreement);

}  // namespace hirosco::supervisor
