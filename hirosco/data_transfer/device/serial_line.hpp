// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "hirosco/utilities/result.hpp"

namespace hirosco {

/// Which line, and how fast. Behind a pseudo-terminal the speed means nothing.
struct SerialLine {
  std::string path;
  std::uint32_t baud{115'200};
};
/// "PATH@BAUD" or "PATH". InvalidArgument: no path, or a speed that no line has.
[[nodiscard]] Result<SerialLine> read_serial_line(std::string_view text);

}  // namespace hirosco
