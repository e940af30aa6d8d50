// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/pus/st08_function/function_service.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"

/// The requests of a subsystem by name, whatever service carries them: for clients, forms and words.
namespace hirosco::pus {

/// SET_STATE, CONFIGURE, what the framework's services have words for (PING, SELF_TEST), the functions of the descriptor, the
/// requests of its own services, and a setting for each writable parameter, `SET:GAINS`, and for what is in it, `SET:GAINS.P`:
/// TC[20,3] with one parameter, whose values are the arguments.
[[nodiscard]] std::vector<descriptor::Function> requests_of(const descriptor::SubsystemDescriptor& subsystem);

/// Whether it takes the way of what is essential, past what waits; a ping asks about the ordinary one.
[[nodiscard]] bool goes_alone(const descriptor::Function& request) noexcept;

/// Begins the name of a setting; no name of a descriptor has a colon.
inline constexpr std::string_view setting_prefix = "SET:";

/// Whether a telecommand of this service and subtype with this application data is such a request; of ST[08], by any name.
[[nodiscard]] bool is_for(const descriptor::Function& request, std::uint8_t service, std::uint8_t subtype, Octets data);

/// Application data of such a request, in `room`. InvalidArgument, OutOfRange: as write_values() has it, or they do not fit.
/// Realtime: bounded.
[[nodiscard]] Result<Octets> write_request(MutableOctets room, const descriptor::Function& request,
                                           GivenValues values) noexcept;
/// The same, of its own.
[[nodiscard]] Result<std::vector<std::byte>> encode_request(const descriptor::Function& request, GivenValues values);

/// The arguments in the application data of such a request, element by element; empty when they are not of its form.
[[nodiscard]] std::optional<std::vector<Value>> decode_request(const descriptor::Function& request, Octets data);

}  // namespace hirosco::pus
