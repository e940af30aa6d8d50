// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "robotics/urdf/robot.hpp"

/// What settings of a device tell a subsystem of its robot: its file, and what of it is meant.
namespace hirosco::robotics::urdf {

/// Settings of a device that whoever reads a robot by them names to use_device().
inline constexpr std::string_view model_setting = "MODEL_FILE";
inline constexpr std::string_view tip_setting = "TIP";
/// Joints of the file that are somebody else's, with commas between them: they stand at 0.
inline constexpr std::string_view fixed_setting = "FIXED";

/// A robot as its file says.
struct NamedRobot {
  std::filesystem::path file;
  std::string text;  ///< of the file
  Robot robot;
  std::vector<std::size_t> led;  ///< joints of it that FIXED names, and what mimics them
  Model model;
  std::vector<std::string> standing;  ///< what FIXED names
};

/// Why there is none. The words live as long as this, and an Error has literals alone: whoever fails with them keeps it.
struct NotRead {
  ErrorCode code{};
  std::string text;
  std::int64_t value{0};
  [[nodiscard]] std::unexpected<Error> error() const { return fail(code, text.c_str(), value); }
};

/// A,B,...
[[nodiscard]] std::vector<std::string> listed_names(std::string_view text);

/// The robot of the file that MODEL_FILE of `device` names in every configuration, without what its FIXED names.  Realtime: allocates.
[[nodiscard]] std::expected<NamedRobot, NotRead> read_named(const descriptor::SubsystemDescriptor& subsystem,
                                                            std::string_view device);
/// The link that TIP of `device` names, or the one end that the robot has.  Realtime: allocates.
[[nodiscard]] std::expected<FrameId, NotRead> named_tip(const descriptor::SubsystemDescriptor& subsystem,
                                                        std::string_view device, const NamedRobot& named);

}  // namespace hirosco::robotics::urdf
