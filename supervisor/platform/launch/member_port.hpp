// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "hirosco/data_transfer/channel/channel.hpp"
#include "hirosco/data_transfer/memory/memory.hpp"
#include "hirosco/subsystem/author/states.hpp"
#include "hirosco/subsystem/pages/pages.hpp"
#include "hirosco/utilities/time.hpp"
#include "supervisor/platform/launch/member_channel.hpp"

/// How the supervisor reaches a started member, wherever that runs (docs/adr/0066).
namespace hirosco::supervisor {

/// What a member counts of its cycle and of its incoming links, as plain numbers of one look.
struct MemberStatistics {
  struct Incoming {
    std::uint32_t link{0};  ///< id, 0 = none
    std::uint32_t lost{0};
    std::uint32_t latency_mean_ns{0};
    std::uint32_t latency_max_ns{0};
    std::uint32_t jitter_ns{0};
    std::uint32_t age_us{0};
    std::uint32_t judged{0};  ///< LinkJudgement; 0 where it does not get across
  };
  std::uint32_t inhibited{0};  ///< bits of Inhibition
  bool realtime{false};
  bool cycling{false};
  std::uint64_t period_ns{0};
  std::uint64_t cycles{0};
  std::uint64_t overruns{0};
  std::uint64_t missed{0};
  std::uint32_t latency_max_ns{0};
  std::uint32_t execution_mean_ns{0};
  std::uint64_t inhibited_at_cycle{0};
  std::array<Incoming, told_incoming_links> incoming;  ///< in the order of <Requires>
};
/// How long the samples of an incoming link took, of one look.
struct MemberLatencies {
  std::uint32_t period_ns{0};  ///< what the bins are parts of; 0 = nothing is counted
  std::array<std::uint32_t, latency_bins> counts{};
};
/// Realtime: wait-free.
[[nodiscard]] MemberStatistics statistics_of(const VitalPage& page) noexcept;

/// A member's channel and its two pages. The pages are the member's own, or where it shares no memory with the supervisor
/// copies that its port keeps: they can be looked at and written at every instant, without a call or a wait, by the
/// supervisor's boxes through this, and by the guard, which has them from the launcher and needs nothing of what stands
/// here. So only how words get across differs. For a packet it costs the one virtual call of its channel.
/// Thread: the supervisor's.
class MemberPort {
 public:
  MemberPort(const MemberPort&) = delete;
  MemberPort& operator=(const MemberPort&) = delete;
  virtual ~MemberPort() = default;

  /// Once in each step of the supervisor: it moves. Takes across what is not shared, and what its channel keeps.
  void beat(std::uint64_t heartbeat, TimePoint now);

  [[nodiscard]] MemberChannel& channel() noexcept { return channel_; }
  /// As it says itself; empty when what it says holds no state.
  [[nodiscard]] std::optional<State> state() const noexcept;
  [[nodiscard]] std::uint8_t configuration() const noexcept;
  /// Empty when what it says is damaged.
  [[nodiscard]] std::optional<MemberStatistics> statistics() const noexcept;
  /// Of the link of MemberStatistics::incoming at this place, below told_incoming_links; nothing of what is damaged.
  [[nodiscard]] MemberLatencies latencies(std::size_t place) const noexcept;
  /// VitalPage::cycles that was read when it was fenced last; for displays.
  [[nodiscard]] std::uint64_t stopped_at_cycle() const noexcept;
  /// Telecommands of another mode are refused by it from now on.
  void enter_mode(std::uint32_t epoch) noexcept;

 protected:
  /// Pages that are smaller than they should be say nothing.
  MemberPort(Channel& channel, Mapping vital, Mapping permit) noexcept;

 private:
  virtual void take_across(TimePoint) {}
  /// Nullptr: it is not a page of ours.
  [[nodiscard]] const VitalPage* vital() const noexcept;

  MemberChannel channel_;
  Mapping vital_memory_, permit_memory_;
  const VitalPage* vital_{nullptr};
  PermitPage* permit_{nullptr};
};

/// A member of this computer: it shares its pages, so nothing has to be taken across.
class LocalMemberPort final : public MemberPort {
 public:
  LocalMemberPort(std::unique_ptr<Channel> channel, Mapping vital, Mapping permit) noexcept;

 private:
  std::unique_ptr<Channel> channel_;
};

}  // namespace hirosco::supervisor
