// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "simulation/spacecraft/spacecraft.hpp"

/// What the simulated spacecraft holds of a subsystem: what a process would. For its own files alone.
namespace hirosco::simulation {

inline constexpr TimePoint never = TimePoint::max();

/// The craft's time as a subsystem reads it: in a cycle that takes long, all readings but the first are later by that.
class MemberClock final : public Clock {
 public:
  explicit MemberClock(const Clock& craft) : craft_{craft} {}
  void begin(Duration takes) noexcept {
    takes_ = takes;
    read_ = false;
  }
  void end() noexcept { takes_ = Duration{0}; }

 private:
  [[nodiscard]] TimePoint do_now() const noexcept override { return craft_.now() + passed(); }
  [[nodiscard]] OnboardTime do_onboard() const noexcept override { return craft_.onboard() + passed(); }
  [[nodiscard]] Duration passed() const noexcept { return std::exchange(read_, true) ? takes_ : Duration{0}; }

  const Clock& craft_;
  Duration takes_{0};
  mutable bool read_{false};
};

/// One subsystem as an object: what a process would hold.
struct Spacecraft::Member {
  Member(const descriptor::MissionSubsystem& what, std::unique_ptr<Subsystem> make, Platform platform)
      : as_started{what},
        author{std::move(make)},
        clock{platform.clock},
        vital{std::make_shared<VitalPage>()},
        permit{std::make_shared<PermitPage>()} {
    const Platform around{.clock = clock,
                          .memory = platform.memory,
                          .flows = platform.flows,
                          .realtime = platform.realtime,
                          .explain = std::move(platform.explain),
                          .links = platform.links,
                          .read_again = [this, changes = descriptor::changes_of(what)](std::string_view text) {
                            return descriptor::read_again(described->subsystem, text, changes);
                          }};
    engine.emplace(*author, what.subsystem, around, channels.subsystem_end(), *vital, *permit);
  }

  descriptor::MissionSubsystem as_started;  ///< outlives the supervisor that started it
  const descriptor::MissionSubsystem* described{&as_started};
  std::unique_ptr<Subsystem> author;
  MemberClock clock;
  ChannelPair channels;
  std::shared_ptr<VitalPage> vital;
  std::shared_ptr<PermitPage> permit;
  std::vector<Mapping> permits;  ///< of supervisors that went on
  [[nodiscard]] PermitPage& newest_permit() noexcept {
    return permits.empty() ? *permit : *reinterpret_cast<PermitPage*>(permits.back().octets.data());
  }
  std::optional<GenericSubsystem> engine;
  TimePoint service_wake{};
  TimePoint cycle_wake{never};
  std::vector<TimePoint> loop_wakes;  ///< of its loops of services of its own
  bool cycling{false};
  bool stopped{false};
  bool spinning{false};
  bool stuck{false};
  TimePoint spins_since{};
  bool realtime_taken{false};
  int strained_cycles{0};
  Duration cycle_takes{0};
  std::optional<supervisor::ProcessEnd> end;
};

/// A simulated process has had the processor only while it spins.
class Spacecraft::Grip final : public supervisor::ProcessGrip {
 public:
  Grip(Spacecraft& craft, std::size_t member) : craft_{craft}, member_{member} {}
  void take_realtime() noexcept override { craft_.members_[member_]->realtime_taken = true; }
  // Service loops of simulated processes take no time, so they keep none from others.
  void take_loops_realtime() noexcept override {}
  void give_realtime() noexcept override { craft_.members_[member_]->realtime_taken = false; }
  supervisor::LoopTime loop_time() noexcept override { return {}; }
  Duration processor_time() noexcept override {
    const Member& member = *craft_.members_[member_];
    return member.spinning ? craft_.now() - member.spins_since : Duration{0};
  }
  void kill() noexcept override { craft_.kill(static_cast<std::uint32_t>(member_ + 1)); }

 private:
  Spacecraft& craft_;
  std::size_t member_;
};

/// What a supervisor that dies in the middle of its step leaves behind.
struct Spacecraft::LastMoment {
  struct Page {
    PermitPage* page;
    std::uint32_t epoch, stop, mode_epoch, newest_stop, powered;
    std::uint64_t go, heartbeat;
  };
  std::vector<Page> pages;
  std::vector<std::byte> journal;
  std::array<std::uint64_t, supervisor::most_inhibits> enabled;
};

template <class Page>
[[nodiscard]] Mapping mapping_of(const std::shared_ptr<Page>& page) {
  return {page, {reinterpret_cast<std::byte*>(page.get()), sizeof(Page)}};
}

}  // namespace hirosco::simulation
