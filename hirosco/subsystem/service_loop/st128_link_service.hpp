// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "hirosco/data_transfer/memory/memory.hpp"
#include "hirosco/pus/st01_verification/verification.hpp"
#include "hirosco/pus/st128_realtime_link/link_handshake.hpp"
#include "hirosco/subsystem/cycle/link_slots.hpp"

/// ST[128] at one end of a link: answers the handshake for the configuration in force.
namespace hirosco {

/// What the service needs of its subsystem.
class LinkServiceOwner {
 public:
  virtual ~LinkServiceOwner() = default;
  /// The required or provided set of the configuration in force; null when there is none.
  virtual const descriptor::Requires* find_required(std::string_view set) = 0;
  virtual const LinkOutputSlot* find_provided(std::string_view set) = 0;
  /// Why no link may be made into a required set, or out of a provided one, now; empty when it may.
  virtual std::string refuse_link(pus::st128::Role role, std::string_view set, std::uint8_t link) = 0;
  virtual Duration period() = 0;
  /// Whether a mechanism of the platform carries such links.
  virtual bool carries(LinkMethod method, LinkKind kind, bool wakes) = 0;
  /// Makes this end of the memory, or at its address, and hands it to the cycle; where it stands.
  virtual Result<LinkRoute> attach(const pus::st128::AttachRequest& request, const MemoryHandle& memory) = 0;
  /// Tells a producer's end where its consumer stands; where it stands itself.
  virtual Result<LinkRoute> reach(const pus::st128::ReachRequest& request) = 0;
  /// Takes an end back from the cycle; false when there is no such link here.
  virtual bool detach(std::uint8_t link) = 0;
};

class LinkService final : public pus::Service {
 public:
  LinkService(pus::Verification& verification, pus::TelemetrySink& sink, LinkServiceOwner& owner)
      : verification_{verification}, sink_{sink}, owner_{owner} {}
  [[nodiscard]] const pus::ServiceKind& kind() const noexcept override { return pus::st128::service_kind; }
  void handle(const pus::TelecommandView& telecommand, const pus::Request& request) override;
  void accompany(const MemoryHandle& memory) override { memory_ = memory; }
  /// Tells the supervisor that an end is gone.
  void report_detached(std::uint8_t link, pus::st128::Role role);

 private:
  void offer(Octets data, const pus::Request& request);
  void negotiate(Octets data, const pus::Request& request);
  void attach(Octets data, const pus::Request& request);
  void reach(Octets data, const pus::Request& request);
  void detach(Octets data, const pus::Request& request);
  /// The outcome of attach and reach.
  void answer(std::uint8_t link, pus::st128::Role role, const Result<LinkRoute>& outcome, const pus::Request& request);
  void refuse(std::uint8_t link, const pus::st128::Refusal& refusal, const pus::Request& request);

  pus::Verification& verification_;
  pus::TelemetrySink& sink_;
  LinkServiceOwner& owner_;
  MemoryHandle memory_;
};

}  // namespace hirosco
