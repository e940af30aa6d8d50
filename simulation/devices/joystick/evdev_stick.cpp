// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/joystick/evdev_stick.hpp"

#include <fcntl.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

namespace hirosco::simulation {
namespace {

constexpr int most_event_devices = 32;

template <std::size_t Octets>
using Bits = std::array<std::uint8_t, Octets>;

template <std::size_t Octets>
bool has(const Bits<Octets>& bits, unsigned bit) noexcept {
  return (bits[bit / 8] >> (bit % 8) & 1) != 0;
}

Result<std::unique_ptr<Stick>> open_one(const std::string& path) {
  int number = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  const bool writable = number >= 0;
  if (!writable) number = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  FileDescriptor events{number};
  if (!events) return fail(ErrorCode::NotFound, "stick cannot be opened", errno);
  Bits<KEY_MAX / 8 + 1> keys{};
  Bits<FF_MAX / 8 + 1> forces{};
  std::array<input_absinfo, 2> axes{};
  (void)::ioctl(events.get(), EVIOCGBIT(EV_KEY, keys.size()), keys.data());
  (void)::ioctl(events.get(), EVIOCGBIT(EV_FF, forces.size()), forces.data());
  const bool is_stick = has(keys, BTN_JOYSTICK) || has(keys, BTN_GAMEPAD);
  if (!is_stick || ::ioctl(events.get(), EVIOCGABS(ABS_X), &axes[0]) < 0 ||
      ::ioctl(events.get(), EVIOCGABS(ABS_Y), &axes[1]) < 0)
    return fail(ErrorCode::Mismatch, "not a joystick or gamepad with two axes");
  const std::array<EvdevStick::Range, 2> ranges{
      {{axes[0].minimum, axes[0].maximum}, {axes[1].minimum, axes[1].maximum}}};
  return std::make_unique<EvdevStick>(std::move(events), ranges, writable && has(forces, FF_CONSTANT));
}

}  // namespace

EvdevStick::EvdevStick(FileDescriptor events, const std::array<Range, 2>& ranges, bool has_force) noexcept
    : events_{std::move(events)}, ranges_{ranges}, has_force_{has_force} {}

Result<std::unique_ptr<Stick>> EvdevStick::open(std::string_view path) {
  if (path != "auto") return open_one(std::string{path});
  for (int i = 0; i < most_event_devices; ++i)
    if (auto stick = open_one("/dev/input/event" + std::to_string(i))) return stick;
  return fail(ErrorCode::NotFound, "no joystick or gamepad on this machine");
}

std::optional<Vec2> EvdevStick::deflection() noexcept {
  std::array<input_event, 32> found;
  const ssize_t octets = ::read(events_.get(), found.data(), sizeof found);
  if (octets == 0 || (octets < 0 && errno != EAGAIN && errno != EINTR)) return std::nullopt;
  const std::size_t count = octets > 0 ? static_cast<std::size_t>(octets) / sizeof(input_event) : 0;
  for (std::size_t i = 0; i < count; ++i) {
    const input_event& event = found[i];
    if (event.type != EV_ABS || event.code > ABS_Y) continue;
    const Range& range = ranges_[event.code];
    if (range.high <= range.low) continue;
    const double width = static_cast<double>(range.high) - range.low;
    deflection_[event.code] = std::clamp(2 * (static_cast<double>(event.value) - range.low) / width - 1, -1.0, 1.0);
  }
  return deflection_;
}

void EvdevStick::feel(const Vec2& share) noexcept {
  constexpr int cycles_between = 40;  // 20 ms: what such motors and their bus can take
  if (!has_force_ || --cycles_to_feel_ > 0) return;
  cycles_to_feel_ = cycles_between;
  const double size = std::min(magnitude(share), 1.0);
  // Direction of the kernel: 0 down, 0x4000 left, in 1/65536 of a turn.
  const double turns = std::atan2(-share[0], share[1]) / (2 * std::numbers::pi);
  ff_effect effect{};
  effect.type = FF_CONSTANT;
  effect.id = effect_;
  effect.direction = static_cast<std::uint16_t>(std::lround(65'536 * (turns < 0 ? turns + 1 : turns)) & 0xFFFF);
  effect.replay.length = 100;  // ms: it ends by itself when nobody goes on asking for it
  effect.u.constant.level = static_cast<std::int16_t>(std::lround(32'767 * size));
  if (::ioctl(events_.get(), EVIOCSFF, &effect) < 0) return;
  effect_ = effect.id;
  const input_event play{.time = {}, .type = EV_FF, .code = static_cast<std::uint16_t>(effect_), .value = 1};
  (void)::write(events_.get(), &play, sizeof play);
}

}  // namespace hirosco::simulation
