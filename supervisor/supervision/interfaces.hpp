// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/pus/packet.hpp"
#include "hirosco/utilities/time.hpp"

/// How the parts of the supervisor are met by what happens. A new part implements what it needs of these and is named once,
/// in parts.hpp.
namespace hirosco::supervisor {

/// Looks after something: called in every watch period of the supervisor.
class Watch {
 public:
  virtual ~Watch() = default;
  virtual void watch(TimePoint now) = 0;
};

/// Hears every report that comes by, after it was logged and routed.
class Hearer {
 public:
  virtual ~Hearer() = default;
  virtual void hear(std::uint16_t from, const pus::TelemetryView& report) = 0;
};

}  // namespace hirosco::supervisor
