// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <string>

#include "hirosco/descriptor/model/subsystem.hpp"

namespace hirosco::descriptor {

/// Where the value of a parameter stands in the reports of whose it is.
struct ReportedAt {
  std::uint16_t structure{0};
  std::size_t offset{0};  ///< behind the id of the structure
  std::size_t octets{0};  ///< of the whole report, with that id; one of another length is of another form
};
/// The same in every configuration, by a structure that comes at least each `age`; or in words why there is none.
[[nodiscard]] std::expected<ReportedAt, std::string> find_reported(const SubsystemDescriptor& subsystem,
                                                                   const ParameterRef& place, Duration age);

}  // namespace hirosco::descriptor
