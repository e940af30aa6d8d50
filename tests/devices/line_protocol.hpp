// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "hirosco/data_transfer/device/frame_protocol.hpp"

namespace hirosco::testing {

/// A protocol as authors have them: lines of text, "S <value>*<CRC-16 in hex>\n" to the device and "V <value>*...\n" from it.
class LineProtocol final : public FrameProtocol {
 public:
  [[nodiscard]] std::size_t say(const DeviceCommand& command, MutableOctets out) noexcept override;
  [[nodiscard]] Heard hear(Octets came) noexcept override;
  void restart() noexcept override { used_ = 0; }
  /// One line, as the device says it.
  [[nodiscard]] static std::string line(char kind, double value);
  /// The value of a whole line without its end; empty: it is none.
  [[nodiscard]] static std::optional<double> value_in(std::string_view line, char kind) noexcept;

 private:
  std::array<char, 64> line_{};
  std::size_t used_{0};
  std::array<std::byte, sizeof(double)> payload_{};
};

}  // namespace hirosco::testing
