// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "hirosco/utilities/os/file_descriptor.hpp"
#include "simulation/devices/joystick/stick.hpp"

namespace hirosco::simulation {

/// A joystick or gamepad of the machine, by Linux's input events; force feedback where it has some.
class EvdevStick final : public Stick {
 public:
  /// Values of an axis from one stop to the other.
  struct Range {
    std::int32_t low{-32'768};
    std::int32_t high{32'767};
  };

  /// `events` gives struct input_event and does not block.
  EvdevStick(FileDescriptor events, const std::array<Range, 2>& ranges, bool has_force) noexcept;
  [[nodiscard]] static Result<std::unique_ptr<Stick>> open(std::string_view path);

  [[nodiscard]] std::optional<Vec2> deflection() noexcept override;
  void feel(const Vec2& share) noexcept override;

 private:
  FileDescriptor events_;
  std::array<Range, 2> ranges_;
  Vec2 deflection_{};
  bool has_force_;
  std::int16_t effect_{-1};  ///< of the kernel, -1: not uploaded yet
  int cycles_to_feel_{0};
};

}  // namespace hirosco::simulation
