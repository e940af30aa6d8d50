// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/data_transfer/device/enable_frame.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"
#include "simulation/devices/device_answers.hpp"
#include "simulation/devices/device_endnodes.hpp"
#include "simulation/devices/further_endnode.hpp"
#include "simulation/devices/further_ends.hpp"
#include "simulation/devices/obedience.hpp"
#include "simulation/devices/simulated_inhibit.hpp"
#include "simulation/devices/simulated_switch.hpp"
#include "simulation/devices/words.hpp"
#include "simulation/devices/world_clock.hpp"

namespace hirosco::simulation {

/// A line for SimulatedDevice::fault with its numbers, as a page offers it, and what it does.
struct FaultLine {
  const char* line;
  const char* text;
};

/// A device as its subsystem meets it: answers each command frame with a status frame, keeps a watchdog of its own,
/// fences old epochs, and can be made to fail. Pure logic, stepped from outside: by the exchange of frames, and by the
/// clock once a command is overdue by a cycle, so that the world does not freeze when its subsystem dies (decision 29).
/// Watchdog: armed by the first command that is not Off. When it trips the device stops, latched, until a command with a
/// higher epoch arrives (decision 7).
/// With an enable endnode (enable_frame.hpp) payloads reach the motors only while the newest enable command says so, names
/// the epoch of the subsystem's frames and is young enough; frames of an epoch that none has named are not obeyed. Whoever
/// takes a moving device's command away, by mode, silence or enable, makes it carry out its declared stop by itself; one
/// whose enable was taken away moves again only with a higher epoch.
/// Who begins is let go: an actuator that has begun (made, power, `reboot`) and hears Active as its first command is latched as
/// if its watchdog had tripped in that epoch. Only it knows that it has just begun (docs/adr/0149).
/// The same holds at each further endnode with an actuator, for itself: FurtherEnds.
/// Realtime: step() is bounded and does not allocate while plugged. Thread: one.
class SimulatedDevice : protected FurtherPayloads {
 public:
  /// What it does by itself when its command is taken away.
  using Stop = DeviceStop;
  struct Settings {
    Duration cycle{std::chrono::microseconds{500}};
    Duration watchdog{std::chrono::milliseconds{10}};  ///< while commands ask for none
    std::endian byte_order{std::endian::little};  ///< of the payload
    std::uint64_t seed{1};
    /// How fast its world runs against the craft; 1 is right. A report that cannot see another number shows nothing.
    double clock{1};
    bool actuator{false};  ///< false: always told Active, and so never let go because it begins
    Stop stop{Stop::Drop};
    Duration stop_within{0};  ///< of Stop::Controlled
    std::optional<FlowAddress> enable{};  ///< endnode of its second inhibit; none: the subsystem's frames suffice
    std::vector<FlowAddress> enable_fall_backs{};  ///< other ways to that
    Duration enable_limit{hirosco::enable_limit};  ///< an older enable command counts as withdrawn
    std::vector<FlowAddress> fall_backs{};  ///< other ways to the same frames
    std::string endnode{};  ///< name of the one that the frames are of, where the device has several; empty: it has one
    std::vector<FurtherEndnode> further{};  ///< the others
    std::optional<FlowAddress> power{};  ///< endnode of its power switch; none: it has power always
    std::vector<FlowAddress> power_fall_backs{};  ///< other ways to that
    /// Files that settings of the device name, by the settings' names: where each is, as file_system() takes it.
    std::map<std::string, std::string> files{};
    /// In whose world it is (docs/adr/0120): plugged in before it, and there as long as it is stepped; null: in one of its own.
    /// Whoever steps them steps one at a time.
    SimulatedDevice* in_world_of{nullptr};
  };
  struct Injection {
    TimePoint at{};
    std::string line;
  };

  /// What every device understands; what its kind does besides is its own `fault_lines`.
  static constexpr std::array common_fault_lines{
      FaultLine{"unplug", "pull the plug: no frames either way"},
      FaultLine{"plug", "put the plug back"},
      FaultLine{"silent", "says nothing any more"},
      FaultLine{"stall 100", "says nothing for 100 ms"},
      FaultLine{"freeze 1000", "the same measurement for 1 s"},
      FaultLine{"corrupt 5", "the next 5 frames are damaged"},
      FaultLine{"delay 20", "every frame 20 ms late"},
      FaultLine{"heal", "all well again"},
      FaultLine{"reboot", "begins anew: forgets what it was told"},
      FaultLine{"enable 0 unplug", "one way to its second inhibit; as with way"},
      FaultLine{"power 0 unplug", "one way to its power switch; as with way"},
      FaultLine{"way 0 silent", "one way to it: unplug, plug, silent, deaf, corrupt N, heal; 1 is the first fall-back"},
  };
  static constexpr std::array<FaultLine, 0> fault_lines{};

  virtual ~SimulatedDevice() = default;
  SimulatedDevice(const SimulatedDevice&) = delete;
  SimulatedDevice& operator=(const SimulatedDevice&) = delete;

  /// Makes its world and opens the flows (the device's side). `flows` must outlive the device. InvalidArgument: it has no such stop.
  [[nodiscard]] Result<> plug();
  [[nodiscard]] bool plugged() const noexcept { return endnodes_.plugged(); }

  /// Takes what came, moves the world, answers.
  void step(TimePoint now);
  /// When step() is due even if no frame comes.
  [[nodiscard]] TimePoint next_wake() const noexcept;
  /// Waits for a frame. Blocks; false at once while there is no peer to wait for (a hang-up would end every wait). True: step()
  /// may find one; of a device with several flows also after a moment without any, as it waits for one of them only.
  [[nodiscard]] bool wait(Duration timeout) noexcept { return endnodes_.wait(timeout); }

  /// Injects a fault from one line of text and records it with the time of the last step:
  ///   unplug | plug | silent | stall MS | freeze MS | corrupt N | delay MS | reboot | heal
  ///   way N WHAT | endnode NAME N WHAT | enable [NAME] N WHAT | power N WHAT   (WHAT: unplug | plug | silent | deaf | corrupt FRAMES | heal; N: 0 preferred, 1 first fall-back)
  /// and what the device adds; heal ends all that was injected, but plugs nothing in and
  /// gives back nothing that a reboot forgot. InvalidArgument, OutOfRange: nothing was done.
  [[nodiscard]] Result<> fault(std::string_view line);
  [[nodiscard]] const std::vector<Injection>& injections() const noexcept { return injections_; }

  [[nodiscard]] std::uint16_t flags() const noexcept { return obedience_.flags(); }
  [[nodiscard]] bool watchdog_tripped() const noexcept { return obedience_.watchdog_tripped(); }
  [[nodiscard]] DeviceOutput output() const noexcept { return obedience_.output(); }
  /// False: its power switch is off. It hears and says nothing, and what moves has brakes or nothing.
  [[nodiscard]] bool powered() const noexcept { return switch_.on(); }
  /// True while payloads of commands reach the motors of the endnode that drives it.
  [[nodiscard]] bool active() const noexcept { return output() == DeviceOutput::Active; }
  /// The same of any of its endnodes.
  [[nodiscard]] bool acts() const noexcept { return active() || further_.active(); }
  /// Cycles that the world has moved, and how many of them the own clock drove.
  [[nodiscard]] std::uint64_t cycles() const noexcept { return clock_.cycles(); }
  [[nodiscard]] std::uint64_t own_cycles() const noexcept { return clock_.own_cycles(); }
  [[nodiscard]] std::uint64_t damaged_commands() const noexcept {
    return damaged_commands_ + inhibit_.damaged_commands() + further_.damaged_commands();
  }
  [[nodiscard]] const Settings& settings() const noexcept { return settings_; }
  /// Whether its motors did anything in the last cycle.
  [[nodiscard]] virtual bool drives() const noexcept { return acts(); }
  /// What whoever starts it is to be told of its world, once it is plugged in: what of its files has no effect there.
  [[nodiscard]] virtual std::vector<std::string> remarks() const { return {}; }
  /// What reckons its world where that is no code of ours, with its version and without a space; empty: nothing does.
  [[nodiscard]] virtual std::string engine() const { return {}; }
  /// World truth as one line of "name=value" words, for people and pages; "world_s" is the time that has passed there, from
  /// which a late host is left out.
  [[nodiscard]] std::string truth() const;

 protected:
  SimulatedDevice(FlowFactory& flows, FlowAddress address, const Settings& settings);

  void raise(std::uint16_t flag, bool on) noexcept { obedience_.raise(flag, on); }
  /// Of Stop::Controlled, while output() is Stopping: what is left of its time.
  [[nodiscard]] Duration stop_left() const noexcept { return obedience_.stop_left(); }
  [[nodiscard]] std::endian byte_order() const noexcept { return settings_.byte_order; }
  /// As output() and stop_left(), of the actuator at a further endnode; take(), write_sensors() and can() are take_at(),
  /// write_sensors_at() and can_at() there (FurtherPayloads).
  [[nodiscard]] DeviceOutput output_at(std::string_view endnode) const noexcept { return further_.output(endnode); }
  [[nodiscard]] Duration stop_left_at(std::string_view endnode) const noexcept { return further_.stop_left(endnode); }

 private:
  /// Moves the world by one cycle under the last accepted payload; output() tells what to do with it.
  virtual void advance(Duration cycle) noexcept = 0;
  /// Nobody else moves in its world: it may stand for this one's sake.
  [[nodiscard]] virtual bool has_world_alone() const noexcept { return true; }
  /// Takes the payload of an accepted active command. Malformed: wrong size.
  [[nodiscard]] virtual Result<> take(OctetReader payload) noexcept = 0;
  virtual void write_sensors(OctetWriter& payload) noexcept = 0;
  /// A fault line of the device's own. InvalidArgument: not known here either.
  [[nodiscard]] virtual Result<> do_fault(const Words& words) = 0;
  [[nodiscard]] virtual std::string do_truth() const = 0;
  /// Forgets what it does not know without power.
  virtual void do_forget() noexcept {}
  /// Takes back what do_fault() did to the device.
  virtual void do_heal() noexcept {}
  /// Which stops it has.
  [[nodiscard]] virtual bool can(Stop stop) const noexcept { return stop == Stop::Drop; }
  /// Before it is plugged in for the first time: makes its world, where that can fail.
  [[nodiscard]] virtual Result<> make_world() { return ok(); }

  void begin_anew() noexcept;
  [[nodiscard]] bool receive(TimePoint now) noexcept;
  [[nodiscard]] bool accept(const DeviceCommand& command, TimePoint now) noexcept;
  void answer(TimePoint now) noexcept;
  [[nodiscard]] Result<> apply_fault(const Words& words);
  void unplug() noexcept;
  void heal() noexcept;

  FlowFactory& flows_;
  Settings settings_;
  DeviceEndnodes endnodes_;
  SimulatedInhibit inhibit_;
  SimulatedSwitch switch_;
  Obedience obedience_;
  FurtherEnds further_;
  WorldClock clock_;
  DeviceAnswers answers_;
  bool world_made_{false};
  std::uint64_t damaged_commands_{0};
  std::uint64_t obeyed_cycles_{0};  ///< cycles() when commands reached the motors last
  std::vector<Injection> injections_;
};

}  // namespace hirosco::simulation
