// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/descriptor/read/read.hpp"

namespace hirosco::tools {

/// What is wrong with the scripts that a descriptor names (docs/adr/0138): a file that is not there (E0422), a line that is none (E0420), and one
/// that asks for what its player may not ask, or in another form than who is asked declares (E0421; names alone where no mission says who
/// that is).
[[nodiscard]] std::vector<descriptor::Diagnostic> script_problems(const descriptor::SubsystemDescriptor& owner,
                                                                  const descriptor::FileSource& source);

}  // namespace hirosco::tools
