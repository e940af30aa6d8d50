// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace hirosco::descriptor {

/// Where an element stands in its file; line and column count from 1.
struct Location {
  int line{0};
  int column{0};
  friend bool operator==(const Location&, const Location&) = default;
};

}  // namespace hirosco::descriptor
