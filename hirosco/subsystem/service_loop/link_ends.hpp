// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/subsystem/cycle/cycle.hpp"
#include "hirosco/subsystem/service_loop/platform.hpp"
#include "hirosco/subsystem/service_loop/reports.hpp"
#include "hirosco/subsystem/service_loop/situation.hpp"
#include "hirosco/subsystem/service_loop/st128_link_service.hpp"

namespace hirosco {

/// The ends of real-time links that a subsystem holds: made, attached to the cycle, taken back.  Thread: the service loop.
class LinkEnds final : private LinkServiceOwner {
 public:
  struct Parts {
    const Platform& platform;
    const Situation& at;
    CycleLoop& cycle;
    LoopRings& rings;
    ResourceMeter& resources;
    Reports& reports;
  };
  explicit LinkEnds(const Parts& parts)
      : parts_{parts}, service_{parts_.reports.verification(), parts_.reports, *this} {}
  LinkEnds(const LinkEnds&) = delete;
  LinkEnds& operator=(const LinkEnds&) = delete;

  /// ST[128], by which the supervisor makes and takes them.
  [[nodiscard]] LinkService& service() noexcept { return service_; }
  /// Whether each set that the configuration in force requires has its link.
  [[nodiscard]] bool required_attached() const noexcept;
  /// The cycle has let go of it.
  void let_go(const AttachedLink* link);
  /// All are told as gone; the cycle may use them until release().
  void end();
  /// The cycle rests.
  void release() { leaving_.clear(); }

 private:
  struct End {
    std::unique_ptr<AttachedLink> link;
    pus::st128::Role role{};
    std::uint32_t epoch{0};
    std::uint16_t slot{0};
  };

  // LinkServiceOwner
  const descriptor::Requires* find_required(std::string_view set) override;
  const LinkOutputSlot* find_provided(std::string_view set) override;
  std::string refuse_link(pus::st128::Role role, std::string_view set, std::uint8_t link) override;
  Duration period() override;
  bool carries(LinkMethod method, LinkKind kind, bool wakes) override;
  Result<LinkRoute> attach(const pus::st128::AttachRequest& request, const MemoryHandle& memory) override;
  Result<LinkRoute> reach(const pus::st128::ReachRequest& request) override;
  bool detach(std::uint8_t link) override;

  /// Each makes one side of what the two agreed on, and says which set of the plan it is.
  Result<std::uint16_t> make_producer(const pus::st128::AttachRequest& request, const LinkMechanism& mechanism,
                                      const MemoryHandle& memory, const LinkLayout& layout, AttachedLink& link);
  Result<std::uint16_t> make_consumer(const pus::st128::AttachRequest& request, const LinkMechanism& mechanism,
                                      const MemoryHandle& memory, const LinkLayout& layout, AttachedLink& link);
  [[nodiscard]] std::shared_ptr<LoanWriter> lender_of(std::uint16_t slot, const LinkLayout& layout);
  bool withdraw(std::uint8_t link);

  Parts parts_;
  LinkService service_;
  std::map<std::uint8_t, End> ends_;
  std::vector<std::unique_ptr<AttachedLink>> leaving_;
  std::string refusal_;  ///< of an error, which does not own its words
};

}  // namespace hirosco
