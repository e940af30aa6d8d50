// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "hirosco/utilities/result.hpp"

namespace hirosco::simulation {

/// Words of one line of text, at most eight.
class Words {
 public:
  explicit Words(std::string_view line) noexcept;
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] std::string_view operator[](std::size_t i) const noexcept { return i < count_ ? words_[i] : ""; }
  /// Word `i` as a finite number within low..high.
  [[nodiscard]] Result<double> number(std::size_t i, double low, double high) const noexcept;
  /// InvalidArgument unless there are exactly `expected` words.
  [[nodiscard]] Result<> expect(std::size_t expected) const noexcept;

 private:
  std::array<std::string_view, 8> words_{};
  std::size_t count_{0};
  bool too_many_{false};
};

}  // namespace hirosco::simulation
