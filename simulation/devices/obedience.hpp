// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/data_transfer/device/enable_frame.hpp"
#include "hirosco/utilities/time.hpp"
#include "simulation/devices/simulated_inhibit.hpp"
#include "simulation/devices/world_clock.hpp"

namespace hirosco::simulation {

/// What a device does by itself when its command is taken away.
enum class DeviceStop : std::uint8_t {
  Drop,  ///< no force at once
  Controlled,  ///< comes to rest within `stop_within`, then holds
  Hold,  ///< holds where it is
};

/// What a simulated device obeys and what becomes of its output: duties 2 to 5 of docs/guide/your_device.md, with its second inhibit.
/// A command is judged first, and accepted once its device could take the payload. Each step watches the watchdog, and then chooses
/// the output.
/// Realtime: wait-free. Thread: one.
class Obedience {
 public:
  struct Declared {
    bool actuator{false};  ///< false: always told Active, and so never let go because it begins
    Duration watchdog{};  ///< while commands ask for none
    DeviceStop stop{DeviceStop::Drop};
    Duration stop_within{};  ///< of DeviceStop::Controlled
  };
  /// `inhibit` must outlive it.
  Obedience(const Declared& declared, const SimulatedInhibit& inhibit) noexcept
      : declared_{declared}, inhibit_{inhibit} {}
  Obedience(const Obedience&) = delete;
  Obedience& operator=(const Obedience&) = delete;

  enum class Verdict : std::uint8_t {
    Refused,  ///< an old epoch
    Heard,  ///< answered, and not obeyed
    Acceptable,  ///< to accept(); the payload is not for the motors
    Obeyed,  ///< to accept(), if its payload can be taken
  };
  struct Judgement {
    Verdict verdict{};
    bool latched{false};  ///< it will be in the epoch of this command
  };
  [[nodiscard]] Judgement judge(const DeviceCommand& command, TimePoint now) noexcept;
  /// As it was judged: from now on it counts.
  void accept(const DeviceCommand& command, const Judgement& judgement, TimePoint now) noexcept;

  /// Trips the watchdog once its time is over.
  void watch(TimePoint now) noexcept;
  void choose_output(TimePoint now) noexcept;
  /// The world has moved by this in a stop.
  void count_down(Duration cycle) noexcept;
  /// Takes it out of the watchdog's time; tells what of the step does not count at all.
  [[nodiscard]] Duration forgive(const WorldClock::Held& held) noexcept;
  /// As it boots: it knows nothing of what was before, and what moves has brakes or nothing.
  void begin_anew() noexcept;

  /// Bits of device_flag: its own, and those of its device.
  void raise(std::uint16_t flag, bool on) noexcept {
    flags_ = static_cast<std::uint16_t>(on ? flags_ | flag : flags_ & ~flag);
  }
  [[nodiscard]] std::uint16_t flags() const noexcept { return flags_; }
  [[nodiscard]] bool watchdog_tripped() const noexcept { return (flags_ & device_flag::watchdog_tripped) != 0; }
  /// When the watchdog trips; the end of time where it is not armed.
  [[nodiscard]] TimePoint trips_at() const noexcept {
    return mode_ != DeviceMode::Off && !watchdog_tripped() ? watchdog_at_ : TimePoint::max();
  }
  [[nodiscard]] DeviceOutput output() const noexcept { return output_; }
  /// Of DeviceStop::Controlled, while output() is Stopping: what is left of its time.
  [[nodiscard]] Duration stop_left() const noexcept { return stop_left_; }
  /// Of the last command that counts.
  [[nodiscard]] std::uint32_t epoch() const noexcept { return epoch_; }
  [[nodiscard]] std::uint32_t sequence() const noexcept { return sequence_; }

 private:
  Declared declared_;
  const SimulatedInhibit& inhibit_;
  bool begins_{true};  ///< and has not heard yet what it may be let go by
  DeviceMode mode_{DeviceMode::Off};
  std::uint32_t epoch_{0};
  std::uint32_t sequence_{0};
  std::uint16_t flags_{0};
  TimePoint watchdog_at_{TimePoint::max()};
  Duration starved_{};  ///< steps since the last command that the watchdog does not count
  DeviceOutput output_{DeviceOutput::Off};
  Duration stop_left_{};
};

}  // namespace hirosco::simulation
