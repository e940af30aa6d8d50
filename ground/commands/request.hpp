// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "ground/commands/way.hpp"
#include "ground/model/answered.hpp"
#include "ground/model/catalogue.hpp"

namespace hirosco::ground {

/// What a telecommand asks for, as a client named it, ready for its packet.
struct Request {
  const descriptor::SubsystemDescriptor* subsystem{};
  std::string function;
  std::uint8_t service{};
  std::uint8_t subtype{};
  Way way{Way::InTurn};
  bool essential{false};
  bool confirm{false};               ///< a person is asked once more
  std::string arguments;             ///< a JSON object with the values that are sent
  std::vector<std::byte> data;
};

/// {subsystem, function, arguments} by the descriptors; a refusal names what does not fit.
[[nodiscard]] Answered<Request> request_of(const Catalogue& catalogue, const nlohmann::json& body);

}  // namespace hirosco::ground
