// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hirosco/data_transfer/channel/channel.hpp"
#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "hirosco/subsystem/author/subscription_port.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// What a subsystem hears of others. It asks the supervisor until that says yes: TC[129,8].  Thread: the service loop.
class Subscriber {
 public:
  /// One that was not answered is sent again after this time.
  static constexpr Duration patience = std::chrono::seconds{1};

  Subscriber(const descriptor::SubsystemDescriptor& described, Channel& channel)
      : descriptor_{described}, channel_{channel} {}

  /// Binds a subscription. What is wrong with it in words; empty when nothing is.
  [[nodiscard]] std::string use(SubscriptionPort& port);
  /// Binds one of the framework's own, which takes whatever this structure has.
  void add(SubscriptionPort& port, const pus::st129::Subscribed& what) {
    bound_.push_back({.port = &port, .what = what});
  }
  /// What a bound one hears begins or ends. NotPermitted: it is not bound.
  [[nodiscard]] Result<> set(SubscriptionPort& port, bool wanted);
  /// A report that came for this subsystem, or by it. True: it was meant for nobody but this.
  bool hear(const pus::TelemetryView& report);
  void step(TimePoint now);
  /// Ends all, and unbinds what was bound.
  void forget();

 private:
  struct Bound {
    SubscriptionPort* port{nullptr};
    pus::st129::Subscribed what{};
    bool wanted{true};
    bool refused{false};
    std::uint32_t request{0};  ///< under way; 0 = none
    TimePoint again{};
  };
  bool ask(Bound& bound);
  [[nodiscard]] bool wanted_by_another(const Bound& bound) const noexcept;
  void hear_verification(const pus::TelemetryView& report);
  bool hear_values(const pus::TelemetryView& report, pus::st129::Subscribed::What what);

  const descriptor::SubsystemDescriptor& descriptor_;
  Channel& channel_;
  std::vector<Bound> bound_;
  std::uint16_t next_count_{0};
};

}  // namespace hirosco
