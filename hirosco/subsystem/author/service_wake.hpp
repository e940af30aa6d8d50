// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// What an author's work in the service loop waits for.
struct ServiceWake {
  /// Waited for until it is readable, and looked at once in a millisecond at most; -1: none. Stays the author's.
  int descriptor{-1};
  /// The longest rest between two calls: from 1 to 10 ms, what is beyond counts as the nearer of the two.
  Duration pace = std::chrono::milliseconds{10};
};

}  // namespace hirosco
