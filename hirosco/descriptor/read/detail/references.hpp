// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/descriptor/read/detail/element_reader.hpp"

namespace hirosco::descriptor::detail {

/// Finds the parameters, and members of them, that a descriptor names.
class References {
 public:
  References(Problems& problems, const SubsystemDescriptor& subsystem) : problems_{problems}, subsystem_{subsystem} {}
  /// Once all parameters are known. `own`: how many are the author's; members of the others are known by their full name only.
  void index(std::size_t own);
  [[nodiscard]] std::optional<ParameterRef> resolve(const xml::Attribute& name, std::string_view user);
  /// What each <ParamRef> of the element names.
  void read_sampled(const xml::Element& element, std::vector<ParameterRef>& into, std::string_view user);
  [[nodiscard]] std::size_t octets_of(const ParameterRef& reference) const;
  /// The author's, not one that every subsystem has.
  [[nodiscard]] bool is_own(const ParameterRef& reference) const noexcept { return reference.parameter < own_; }

 private:
  /// The `name` attribute resolved against the parameters.
  [[nodiscard]] std::optional<ParameterRef> read_reference(Attributes& attributes, std::string_view user);
  [[nodiscard]] std::string suggest_reference(std::string_view text) const;

  Problems& problems_;
  const SubsystemDescriptor& subsystem_;
  std::size_t own_{0};
  std::map<std::string, std::vector<ParameterRef>, std::less<>> references_;  ///< by every spelling
};

}  // namespace hirosco::descriptor::detail
