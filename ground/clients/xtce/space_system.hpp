// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <list>
#include <string>
#include <string_view>
#include <vector>

#include "ground/clients/xtce/element.hpp"

/// One space system of an XTCE database while it is put together. Paths are absolute: "/MISSION/ARM/CUR_VALUES/POSITION".
namespace hirosco::ground {

/// A condition under which a container is what a packet holds. Numbers, never their names.
struct Condition {
  std::string parameter;
  std::string value;
  std::string comparison{"=="};
};

struct Container {
  std::string name;
  std::string says{};
  std::vector<Element> entries{};
  std::string base{};  ///< path; empty = a root, or one that is included
  std::vector<Condition> when{};  ///< all of them
  std::vector<Condition> or_when{};  ///< and one of these
  bool abstract{false};
  bool partition{false};  ///< an archive keeps its packets under its name
};

class SpaceSystem {
 public:
  SpaceSystem(std::string_view name, std::string_view parent, std::string_view says);
  SpaceSystem(const SpaceSystem&) = delete;
  SpaceSystem& operator=(const SpaceSystem&) = delete;

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  /// Lives as long as this one.
  SpaceSystem& add_system(std::string_view name, std::string_view says = {});
  /// `id`: as which an id on the wire finds it; empty = none does. Returns the path.
  std::string add_parameter(std::string_view name, const std::string& type, std::string_view says = {},
                            std::string_view id = {});
  std::string add_container(const Container& container);
  /// `command` is a MetaCommand without its name, which is given here.
  std::string add_command(std::string_view name, Element command);
  [[nodiscard]] std::string free_command_name(std::string_view name) { return command_names_.unique(name); }

  /// Types and children as XTCE orders them.
  [[nodiscard]] Element element(std::vector<Element> parameter_types = {}, std::vector<Element> argument_types = {},
                                std::vector<Element> header = {}) const;

 private:
  std::string name_, path_, says_;
  XtceNames names_, container_names_, command_names_;
  std::vector<Element> parameters_, containers_, commands_;
  std::list<SpaceSystem> systems_;
};

/// Name space of the ids of parameters on the wire.
inline constexpr const char* wire_ids = "parameter id on the wire";

[[nodiscard]] Element entry_of(const std::string& parameter);
/// At a bit of the packet, whatever was read before.
[[nodiscard]] Element entry_at(const std::string& parameter, unsigned bit);
[[nodiscard]] Element included(const std::string& container);
[[nodiscard]] Element included_times(const std::string& container, std::uint32_t times);
/// As often as a parameter says.
[[nodiscard]] Element included_by(const std::string& container, const std::string& parameter);

}  // namespace hirosco::ground
