// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

namespace hirosco::ground {

struct PythonFile {
  std::string_view name, text;
};

/// What all exported packages share, as it was when this was built. Who uses one imports the package; its files import each other.
extern const std::array<PythonFile, 7> python_runtime;

}  // namespace hirosco::ground
