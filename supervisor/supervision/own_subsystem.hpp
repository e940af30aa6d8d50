// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <set>
#include <string_view>

#include "hirosco/data_transfer/channel/channel_pair.hpp"
#include "hirosco/subsystem/author/subsystem.hpp"
#include "hirosco/subsystem/service_loop/generic_subsystem.hpp"
#include "supervisor/platform/launch/member_port.hpp"
#include "supervisor/supervision/succession/journal.hpp"

namespace hirosco::supervisor {

/// The subsystem that the supervisor is itself (paper 4.3): its functions are telecommands like any other, its telemetry
/// takes the same way through permission, log and route. Thread: the supervisor's, its cycle too.
class OwnSubsystem final : public Remembered, private Subsystem {
 public:
  /// Whoever gives it functions and parameters, and shows these in each of its cycles.
  class Author {
   public:
    virtual ~Author() = default;
    virtual void provide(OwnSubsystem& own) = 0;
    virtual void show() noexcept = 0;
  };
  OwnSubsystem(const descriptor::SubsystemDescriptor& described, const Platform& platform, Author& author);

  using Subsystem::abort;
  using Subsystem::finish;
  using Subsystem::on_function;
  using Subsystem::progress;
  using Subsystem::publish;

  /// Its actuators, of which it has none, are never inhibited.
  void start(std::uint32_t mode_epoch);
  void beat(std::uint64_t heartbeat) noexcept { permit_->heartbeat.store(heartbeat, std::memory_order_release); }
  [[nodiscard]] std::uint64_t beats() const noexcept { return permit_->heartbeat.load(std::memory_order_relaxed); }
  void enter_mode(std::uint32_t epoch) noexcept { permit_->mode_epoch.store(epoch, std::memory_order_release); }
  /// The same two steps as everybody's, here in one thread; returns when the next is due at the latest.
  TimePoint step(TimePoint now);
  /// There is something to do for it, or something of it to read, since its last step.
  [[nodiscard]] bool has_work() const noexcept { return !channels_.empty() || runner_.has_reports(); }

  /// An event of its descriptor by name.
  void announce(std::string_view event, std::initializer_list<double> arguments = {}) {
    runner_.reports().announce(event, arguments);
  }
  /// Those of these events that no safety rests on are not reported any more, from now on; whoever reacts to them hears them as ever.
  void keep_silent(const std::set<std::uint16_t>& events);
  [[nodiscard]] pus::Verification& verification() noexcept { return runner_.verification(); }
  [[nodiscard]] pus::TelemetrySink& telemetry() noexcept { return runner_.telemetry(); }
  /// The end of its channel at which the supervisor sends telecommands and takes reports.
  [[nodiscard]] Channel& channel() noexcept { return channels_.supervisor_end(); }
  [[nodiscard]] descriptor::State state() const noexcept { return runner_.state(); }
  [[nodiscard]] std::uint8_t configuration() const noexcept {
    return static_cast<std::uint8_t>(vital_->configuration.load(std::memory_order_relaxed));
  }
  [[nodiscard]] MemberStatistics statistics() const noexcept { return statistics_of(*vital_); }
  /// The counts of its packets (decision 8b). What ground has set of it is noted by CommandedMembers (docs/adr/0205).
  void note(OctetWriter& writer) const override;
  void recall(OctetReader& reader) override;

 private:
  using Subsystem::telemetry;  // of the ground link only
  Result<Step> software_init() override;
  Result<> pre_operational(const Cycle&) noexcept override { return show(); }
  Result<> safe_operational(const Cycle&) noexcept override { return show(); }
  Result<> operational(const Cycle&) noexcept override { return show(); }
  Result<> error_operational(const Cycle&) noexcept override { return show(); }
  Result<> show() noexcept {
    author_.show();
    return ok();
  }

  Author& author_;
  ChannelPair channels_;
  std::unique_ptr<VitalPage> vital_;
  std::unique_ptr<PermitPage> permit_;
  GenericSubsystem runner_;
  TimePoint next_cycle_{};
  bool cycles_{false};
};

}  // namespace hirosco::supervisor
