// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"

/// The events that every subsystem has without declaring them (docs/adr/0020), as it has SET_STATE: who supervises it
/// must hear of them whatever its author wrote down.
namespace hirosco::descriptor {

namespace framework_event {
/// Ids from here on are the framework's.
inline constexpr std::uint16_t first = 0xF000;
inline constexpr std::uint16_t state_changed = 0xF000;
inline constexpr std::uint16_t state_failed = 0xF001;
inline constexpr std::uint16_t configuration_failed = 0xF002;
inline constexpr std::uint16_t cycle_overruns = 0xF003;
inline constexpr std::uint16_t reports_lost = 0xF004;
inline constexpr std::uint16_t supervisor_silent = 0xF005;
inline constexpr std::uint16_t cycle_over_budget = 0xF006;
inline constexpr std::uint16_t resource_warning = 0xF007;
inline constexpr std::uint16_t cycle_not_realtime = 0xF008;
/// Only where services run in loops of their own.
inline constexpr std::uint16_t service_loop_hangs = 0xF009;
/// Only where a parameter has the value of another subsystem's.
inline constexpr std::uint16_t foreign_unknown = 0xF00A;
inline constexpr std::uint16_t service_uses_heap = 0xF00B;
/// Of the device with this index, NAME_LOST.
[[nodiscard]] constexpr std::uint16_t device_lost(std::size_t device) noexcept {
  return static_cast<std::uint16_t>(0xF100 + device);
}
/// Of the set with this index in required_sets(), NAME_STALE.
[[nodiscard]] constexpr std::uint16_t set_stale(std::size_t set) noexcept {
  return static_cast<std::uint16_t>(0xF200 + set);
}
/// Of the device with this index, NAME_FALL_BACK; only where a configuration gives it a fall-back.
[[nodiscard]] constexpr std::uint16_t fell_back(std::size_t device) noexcept {
  return static_cast<std::uint16_t>(0xF300 + device);
}
/// Octets of the TEXT of a failure: what is longer is cut, what is shorter is filled with zeros.
inline constexpr std::uint16_t text_octets = 64;
}  // namespace framework_event

/// Why a device counts as lost; what came instead of good frames most often.
enum class DeviceLoss : std::uint8_t {
  Silent = 1,     ///< nothing came
  HungUp = 2,     ///< its data flow ended
  Damaged = 3,    ///< frames came, their checksum or form was wrong
  WrongSize = 4,  ///< good frames came, of another size than declared
  Repeated = 5,   ///< the same frame came again and again: it answers no newer command
  LetGo = 6,      ///< its watchdog has tripped although it is commanded
  NotOpened = 7,  ///< its data flow could not be opened
  OldEpoch = 8,   ///< it refuses ours: it obeys a higher epoch, of another flight
  NeverHeard = 9, ///< nothing good has come since its data flow was opened
  OtherVersion = 10,  ///< frames of another version came: what it runs was built against another hirosco
};

/// Names of the sets that any configuration requires, each once, in the order of the descriptor.
[[nodiscard]] std::vector<std::string> required_sets(const SubsystemDescriptor& subsystem);
/// Appends the framework's events and the enumerations that their arguments need, and its parameters
/// (framework_parameters.hpp); those that are there stay as they are.
void add_framework_events(SubsystemDescriptor& subsystem);

}  // namespace hirosco::descriptor

namespace hirosco {
template <>
struct EnumTexts<descriptor::DeviceLoss> {
  using enum descriptor::DeviceLoss;
  static constexpr auto table = enum_table<descriptor::DeviceLoss>({{Silent, "silent"},
                                                                    {HungUp, "hung up"},
                                                                    {Damaged, "damaged frames"},
                                                                    {WrongSize, "wrong size"},
                                                                    {Repeated, "repeated frames"},
                                                                    {LetGo, "watchdog let go"},
                                                                    {NotOpened, "not opened"},
                                                                    {OldEpoch, "old epoch refused"},
                                                                    {NeverHeard, "never heard"},
                                                                    {OtherVersion, "frames of another version"}});
};
}  // namespace hirosco
