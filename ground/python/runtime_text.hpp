// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace hirosco::ground {

/// The text of runtime.py as it was when this was built.
extern const std::string_view python_runtime;

}  // namespace hirosco::ground
