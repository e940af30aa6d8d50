// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/urdf/named_robot.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "hirosco/descriptor/model/setting_files.hpp"

namespace hirosco::robotics::urdf {
namespace {

[[nodiscard]] std::unexpected<NotRead> not_read(ErrorCode code, std::string text, std::int64_t value = 0) {
  return std::unexpected{NotRead{code, std::move(text), value}};
}

[[nodiscard]] std::unexpected<NotRead> not_read(const Error& error) {
  return not_read(error.code, error.text, error.value);
}

}  // namespace

std::vector<std::string> listed_names(std::string_view text) {
  std::vector<std::string> names;
  while (!text.empty()) {
    names.emplace_back(text.substr(0, text.find(',')));
    text.remove_prefix(std::min(text.size(), names.back().size() + 1));
  }
  return names;
}

std::expected<NamedRobot, NotRead> read_named(const descriptor::SubsystemDescriptor& subsystem,
                                              std::string_view device) {
  const auto named = descriptor::setting_of_all(subsystem, device, model_setting);
  if (!named) return not_read(named.error());
  const auto fixed = descriptor::setting_of_all(subsystem, device, fixed_setting);
  if (!fixed) return not_read(fixed.error());
  if (named->empty())
    return not_read(ErrorCode::NotFound,
                    fmt::format("no configuration names a URDF file: setting {} of {}", model_setting, device));
  const auto file = descriptor::file_of(subsystem, *named);
  auto text = descriptor::file_system()(file);
  if (!text) return not_read(text.error().code, fmt::format("{} {}", file.string(), text.error().text));
  auto reading = read(file, *text);
  if (!reading.value) {
    const auto& first = reading.problems.front();
    return not_read(ErrorCode::Malformed,
                    fmt::format("{}:{}:{}: {}: {}", file.filename().string(), first.at.line, first.at.column,
                                first.code, first.message),
                    static_cast<std::int64_t>(reading.problems.size()));
  }
  auto standing = listed_names(*fixed);
  auto led = led_by(*reading.value, standing);
  if (const auto unknown = fix(*reading.value, standing))
    return not_read(ErrorCode::NotFound, fmt::format("{} of {}: the robot has no joint '{}' that moves by itself",
                                                     fixed_setting, device, *unknown));
  auto model = Model::make(describe(*reading.value));
  if (!model) return not_read(model.error());
  return NamedRobot{file,           std::move(*text),  std::move(*reading.value),
                    std::move(led), std::move(*model), std::move(standing)};
}

std::expected<FrameId, NotRead> named_tip(const descriptor::SubsystemDescriptor& subsystem, std::string_view device,
                                          const NamedRobot& named) {
  const auto said = descriptor::setting_of_all(subsystem, device, tip_setting);
  if (!said) return not_read(said.error());
  const auto ends = tips(named.robot);
  if (said->empty() && ends.size() != 1)
    return not_read(ErrorCode::InvalidArgument,
                    fmt::format("the robot has several ends: setting {} of {} names the link", tip_setting, device),
                    static_cast<std::int64_t>(ends.size()));
  const std::string& link = said->empty() ? ends.front() : *said;
  const auto found = named.model.find_frame(link);
  if (!found)
    return not_read(ErrorCode::NotFound,
                    fmt::format("{} of {}: the robot has no link '{}'", tip_setting, device, link));
  return *found;
}

}  // namespace hirosco::robotics::urdf
