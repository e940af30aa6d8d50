// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace hirosco::terminal {

/// Lines out of octets as they come. One that gets too long is left out as a whole: half of it says nothing.
class Lines {
 public:
  explicit Lines(std::size_t longest) : longest_{longest} {}
  template <class With>
  void take(std::string_view octets, With&& with) {
    while (!octets.empty()) {
      const std::size_t end = octets.find('\n');
      const std::string_view part = octets.substr(0, end);
      if (line_.size() + part.size() > longest_) too_long_ = true;
      if (too_long_) line_.clear();
      else line_ += part;
      if (end == std::string_view::npos) return;
      if (!std::exchange(too_long_, false)) with(std::string_view{line_});
      line_.clear();
      octets.remove_prefix(end + 1);
    }
  }

 private:
  std::size_t longest_;
  std::string line_;
  bool too_long_{false};
};

}  // namespace hirosco::terminal
