// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/dynamics/lines.hpp"

namespace hirosco::tools {

BoundedLines::Next BoundedLines::next() {
  line_.clear();
  bool any = false, too_long = false;
  for (int octet = 0; (octet = std::getc(file_)) != EOF && octet != '\n'; any = true) {
    if (too_long) continue;
    too_long = line_.size() == most_;
    if (too_long) std::string{}.swap(line_);
    else line_.push_back(static_cast<char>(octet));
  }
  if (std::ferror(file_) != 0) return Next::Failed;
  if (too_long) return Next::TooLong;
  // The last one may lack its end.
  return any || std::feof(file_) == 0 ? Next::Line : Next::End;
}

}  // namespace hirosco::tools
