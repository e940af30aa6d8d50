// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hirosco/subsystem/testing/rig.hpp"

namespace hirosco::testing {

/// Calls each function of a subsystem with numbers of all its ranges, and looks what has become of its protections and of what any of
/// them says that it `sets`: a function that changes a protection and does not say so is one whose limits a crash loses, and the
/// subsystem moves again without them (docs/adr/0170).
class TriedFunctions {
 public:
  /// Before each call `begin` brings it to where its functions are obeyed; `settle` lets them be carried out.
  TriedFunctions(Rig& rig, const std::function<void()>& begin, const std::function<void()>& settle) : rig_{rig} {
    const auto& functions = descriptor().functions;
    for (std::size_t i = 0; i < descriptor().parameters.size(); ++i) {
      const auto named = [i](const descriptor::Function& function) { return says(function, i); };
      if (descriptor().parameters[i].protection || std::ranges::any_of(functions, named)) watched_.push_back(i);
    }
    // The lowest last: what a function leaves behind is in the way of those that follow least.
    constexpr std::array<std::optional<double>, 3> shares{std::nullopt, 1.0, 0.0};
    for (const descriptor::Function& function : functions)
      for (const auto& share : shares) {
        begin();
        const auto before = values();
        rig_.call_with(function.name, arguments(function, share));
        settle();
        const auto after = values();
        for (const std::size_t parameter : watched_)
          if (before.at(parameter).empty() || before.at(parameter) != after.at(parameter))
            changed_[function.name].insert(parameter);
      }
  }

  /// "SET_LIMITS LIMITS": it changes the protection, and does not say so.
  [[nodiscard]] std::vector<std::string> untold() const {
    return those([this](const descriptor::Function& function, std::size_t parameter) {
      return descriptor().parameters[parameter].protection && changes(function, parameter) &&
             !says(function, parameter);
    });
  }
  /// "SET_LIMITS LIMITS": it says that it sets it, and never did.
  [[nodiscard]] std::vector<std::string> idle() const {
    return those([this](const descriptor::Function& function, std::size_t parameter) {
      return says(function, parameter) && !changes(function, parameter);
    });
  }

 private:
  [[nodiscard]] const descriptor::SubsystemDescriptor& descriptor() const { return rig_.descriptor(); }
  [[nodiscard]] static bool says(const descriptor::Function& function, std::size_t parameter) {
    return std::ranges::find(function.unrepeated, parameter) != function.unrepeated.end();
  }
  [[nodiscard]] bool changes(const descriptor::Function& function, std::size_t parameter) const {
    const auto found = changed_.find(function.name);
    return found != changed_.end() && found->second.contains(parameter);
  }
  [[nodiscard]] std::vector<std::string> those(const auto& wanted) const {
    std::vector<std::string> all;
    for (const descriptor::Function& function : descriptor().functions)
      for (const std::size_t parameter : watched_)
        if (wanted(function, parameter))
          all.push_back(function.name + " " + descriptor().parameters[parameter].field.name);
    return all;
  }
  /// As ST[20] reports them.
  [[nodiscard]] std::map<std::size_t, std::string> values() {
    std::map<std::size_t, std::string> all;
    for (const std::size_t i : watched_) {
      const descriptor::Parameter& parameter = descriptor().parameters[i];
      std::array<std::byte, 5> data{};
      OctetWriter{data}
          .put(std::uint8_t{1})
          .put(ParameterId{descriptor().id, parameter.field.type, parameter.id}.wire());
      rig_.forget_telemetry();
      rig_.send(20, 1, data);
      auto reports = rig_.reports(20, 2);
      for (int step = 0; step < 5 && reports.empty(); ++step) {
        rig_.service();
        reports = rig_.reports(20, 2);
      }
      all[i] = reports.empty() ? "" : reports.back();
    }
    return all;
  }
  /// All at one place of their ranges, or each farther up in its own than the one before: limits that ascend do so.
  [[nodiscard]] static std::vector<std::optional<Value>> arguments(const descriptor::Function& function,
                                                                   const std::optional<double>& share) {
    std::size_t count = 0;
    for (const auto& argument : function.arguments) count += argument.field.values();
    std::vector<std::optional<Value>> all;
    for (const auto& argument : function.arguments)
      for (std::uint32_t i = 0; i < argument.field.values(); ++i)
        all.emplace_back(
            value_of(argument, share.value_or(static_cast<double>(all.size() + 1) / static_cast<double>(count + 1))));
    return all;
  }
  [[nodiscard]] static Value value_of(const descriptor::Function::Argument& argument, double share) {
    const descriptor::Field& field = argument.field;
    if (field.type == Type::Text) return std::string{"x"};
    if (!field.minimum || !field.maximum) {
      const auto last = static_cast<double>(argument.texts.size() - 1);
      return Number{argument.texts.at(static_cast<std::size_t>(std::floor(share * last))).value};
    }
    if (share >= 1) return *field.maximum;
    const double value = std::lerp(field.minimum->real(), field.maximum->real(), share);
    if (field.type == Type::Float || field.type == Type::Double) return Number{value};
    return Number{static_cast<std::int64_t>(std::floor(value))};
  }

  Rig& rig_;
  std::vector<std::size_t> watched_;  ///< indices of parameters
  std::map<std::string, std::set<std::size_t>> changed_;  ///< by the name of the function
};

}  // namespace hirosco::testing
