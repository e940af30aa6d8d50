// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: permission (docs/safety/modules.csv).
#include "supervisor/supervision/telecommand/called_function.hpp"

#include <cstddef>

#include "hirosco/utilities/octets.hpp"

namespace hirosco::supervisor {
namespace {

constexpr std::size_t name_octets = 16;

}  // namespace

std::optional<CalledFunction> function_of_call(const pus::TelecommandView& telecommand) {
  const Octets data = telecommand.application_data();
  if (data.size() < name_octets) return std::nullopt;
  const auto* letters = reinterpret_cast<const char*>(data.data());
  CalledFunction call;
  call.name = std::string_view{letters, name_octets};
  call.name = call.name.substr(0, call.name.find('\0'));
  // N u8, argument id u8, value u8: the shape of SET_STATE and its kin.
  if (data.size() == name_octets + 3) call.first_argument = std::to_integer<std::uint8_t>(data[name_octets + 2]);
  return call;
}

}  // namespace hirosco::supervisor
