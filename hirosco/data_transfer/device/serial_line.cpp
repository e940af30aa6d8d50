// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/serial_line.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace hirosco {
namespace {

constexpr std::size_t longest_line_path = 200;
constexpr std::array line_speeds{1200U,      2400U,      4800U,      9600U,     19'200U,  38'400U,
                                 57'600U,    115'200U,   230'400U,   460'800U,  500'000U, 921'600U,
                                 1'000'000U, 2'000'000U, 3'000'000U, 4'000'000U};

}  // namespace

Result<SerialLine> read_serial_line(std::string_view text) {
  SerialLine line;
  if (const auto at = text.rfind('@'); at != text.npos) {
    const std::string_view baud = text.substr(at + 1);
    const auto [end, error] = std::from_chars(baud.data(), baud.data() + baud.size(), line.baud);
    if (error != std::errc{} || end != baud.data() + baud.size() ||
        std::ranges::find(line_speeds, line.baud) == line_speeds.end())
      return fail(ErrorCode::InvalidArgument, "no line has this speed");
    text = text.substr(0, at);
  }
  if (text.empty() || text.size() > longest_line_path || text.find('\0') != text.npos)
    return fail(ErrorCode::InvalidArgument, "path of a serial line");
  line.path = text;
  return line;
}

}  // namespace hirosco
