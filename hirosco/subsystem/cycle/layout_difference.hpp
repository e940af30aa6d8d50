// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "hirosco/data_transfer/wire_layout.hpp"
#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/parameter/native_layout.hpp"

namespace hirosco {

/// Compares a port's C++ layout with the fields of the descriptor; empty when they agree, else all that differs.
[[nodiscard]] std::string layout_difference(std::span<const NativeField> native,
                                            const std::vector<descriptor::Field>& declared);

/// The fields of an object that agrees with its declaration, as they are encoded, with the lengths that this gives.
[[nodiscard]] std::vector<LayoutField> agreed_layout(ObjectFields& fields,
                                                     const std::vector<descriptor::Field>& declared,
                                                     MutableOctets object);

}  // namespace hirosco
