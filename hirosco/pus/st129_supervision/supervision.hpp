// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/pus/service/service_kind.hpp"

/// ST[129], ours: what ground and the supervisor say about telecommands.
///
///   TC[129,1]  would this telecommand be permitted now?  the whole packet asked about
///   TM[129,2]  the answer: its request id u32, 1 or 0 u8, failure code of the refusal u16 (0 = none)
///   TM[129,3]  copy of a telecommand that the supervisor has received from a ground, to every ground: the whole packet
namespace hirosco::pus::st129 {

inline constexpr std::uint8_t service_type = 129;
extern const ServiceKind service_kind;
enum Subtype : std::uint8_t { permission_question = 1, permission_answer = 2, telecommand_copy = 3 };

}  // namespace hirosco::pus::st129
