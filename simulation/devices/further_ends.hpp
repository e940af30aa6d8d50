// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/enable_frame.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"
#include "simulation/devices/further_endnode.hpp"
#include "simulation/devices/obedience.hpp"
#include "simulation/devices/simulated_inhibit.hpp"
#include "simulation/devices/world_clock.hpp"

namespace hirosco::simulation {

/// What a simulated device takes and says at its further endnodes, by their names: nothing unless it does.
class FurtherPayloads {
 public:
  /// Of an accepted active command. Malformed: wrong size, or nothing is taken there.
  [[nodiscard]] virtual Result<> take_at(std::string_view endnode, OctetReader payload) noexcept;
  virtual void write_sensors_at(std::string_view endnode, OctetWriter& payload) noexcept;
  /// Whether it has motors there, and such a stop of them.
  [[nodiscard]] virtual bool can_at(std::string_view endnode, DeviceStop stop) const noexcept;

 protected:
  ~FurtherPayloads() = default;
};

/// What runs at the further endnodes of a simulated device. One with an actuator obeys for itself (Obedience, docs/adr/0220): it has an
/// epoch, a watchdog, a stop and a second inhibit of its own, so that who is silenced there stops nothing else. One without answers whoever asks.
/// Realtime: bounded, and does not allocate but in open(). Thread: one.
class FurtherEnds {
 public:
  /// `watchdog`: of an actuator while commands ask for none; `device` outlives it.
  FurtherEnds(std::span<const FurtherEndnode> described, Duration watchdog, Duration enable_limit,
              FurtherPayloads& device);
  FurtherEnds(const FurtherEnds&) = delete;
  FurtherEnds& operator=(const FurtherEnds&) = delete;

  /// Opens their second inhibits, once. InvalidArgument: the device has no motors at one that is to have some, or no such stop.
  [[nodiscard]] Result<> open(FlowFactory& flows);

  // --- a step of the device, in this order --------------------------------------------------------------------------------
  /// The most that the watchdog of one of them forgives.
  [[nodiscard]] Duration forgive(const WorldClock::Held& held) noexcept;
  /// Takes what came for actuators. Nothing is heard where `powered` is false. True: an acceptable command was among it.
  [[nodiscard]] bool receive(std::span<FurtherExchange> ends, TimePoint now, bool powered) noexcept;
  void choose_output(TimePoint now) noexcept;
  /// The world has moved by this.
  void count_down(Duration cycle) noexcept;
  struct Said {
    std::uint16_t flags{0};  ///< of the device
    bool powered{true};
    bool plugged{true};
    bool silent{false};
  };
  /// Answers who asked, once; whose epoch is an old one is told that.
  void answer(std::span<FurtherExchange> ends, const Said& said) noexcept;

  /// As it boots.
  void begin_anew() noexcept;
  /// As if no enable command had come.
  void withdraw() noexcept;

  /// The ways to the second inhibit there; null: there is none.
  [[nodiscard]] EndnodeWays* inhibit_ways(std::string_view endnode) noexcept;
  /// Ends what was done to ways of second inhibits.
  void heal() noexcept;

  /// Off where there is no actuator.
  [[nodiscard]] DeviceOutput output(std::string_view endnode) const noexcept;
  [[nodiscard]] Duration stop_left(std::string_view endnode) const noexcept;
  /// Payloads of commands reach the motors of one of them.
  [[nodiscard]] bool active() const noexcept;
  /// When a watchdog trips or an enable ends; the end of time where none does.
  [[nodiscard]] TimePoint next_wake() const noexcept;
  [[nodiscard]] std::uint64_t damaged_commands() const noexcept;

 private:
  /// An endnode with an actuator.
  struct Drive {
    Drive(const FurtherEndnode& described, Duration watchdog, Duration enable_limit);
    std::string name;
    DeviceStop stop;
    SimulatedInhibit inhibit;
    Obedience obedience;
    bool asked{false};  ///< and not answered yet
  };
  [[nodiscard]] Drive* drive_of(std::string_view endnode) const noexcept;
  [[nodiscard]] bool receive(FurtherExchange& end, Drive& drive, TimePoint now, bool powered) noexcept;
  [[nodiscard]] bool asked(FurtherExchange& end, bool powered) noexcept;

  FurtherPayloads& device_;
  std::vector<std::unique_ptr<Drive>> drives_;
  std::uint64_t damaged_commands_{0};
};

}  // namespace hirosco::simulation
