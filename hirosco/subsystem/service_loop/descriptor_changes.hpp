// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/parameter/parameter.hpp"
#include "hirosco/pus/st130_descriptor/descriptor_service.hpp"
#include "hirosco/subsystem/service_loop/own_loops.hpp"
#include "hirosco/subsystem/service_loop/parameter_values.hpp"
#include "hirosco/subsystem/service_loop/platform.hpp"
#include "hirosco/subsystem/service_loop/situation.hpp"

namespace hirosco {

/// The descriptor in force, as housekeeping.
struct DescriptorInForce {
  std::uint32_t hash{};  ///< CRC-32 of its text
  std::uint16_t changes{};  ///< taken since the process started
};

/// Another text of the descriptor in the same process (docs/adr/0095): judged, then taken in one piece or not at all.
/// Thread: the service loop.
class DescriptorChanges final : public pus::DescriptorOwner {
 public:
  DescriptorChanges(descriptor::SubsystemDescriptor& descriptor, const Platform& platform, const Situation& at,
                    ParameterValues& values, const OwnLoops& loops)
      : descriptor_{descriptor}, platform_{platform}, at_{at}, values_{values}, loops_{loops} {}

  /// Which text is in force, as housekeeping: from Software-Init on, and at once where that was already.
  void tell();
  [[nodiscard]] Parameter<DescriptorInForce>& in_force() noexcept { return in_force_; }

  // DescriptorOwner
  std::optional<pus::FailureNotice> judge(std::size_t octets, const MemoryHandle& text) override;
  std::optional<pus::FailureNotice> take() override;

 private:
  [[nodiscard]] std::optional<pus::FailureNotice> not_now() const noexcept;
  [[nodiscard]] std::optional<pus::FailureNotice> against(const descriptor::SubsystemDescriptor& fresh);
  [[nodiscard]] std::optional<pus::FailureNotice> left_outside(const descriptor::SubsystemDescriptor& fresh);

  descriptor::SubsystemDescriptor& descriptor_;
  const Platform& platform_;
  const Situation& at_;
  ParameterValues& values_;
  const OwnLoops& loops_;
  std::optional<descriptor::SubsystemDescriptor> coming_;  ///< judged, and not taken yet
  bool newest_{false};  ///< nothing was to be judged behind it
  Parameter<DescriptorInForce> in_force_;
  std::uint16_t changes_{0};
};

}  // namespace hirosco
