// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "hirosco/data_transfer/channel/channel.hpp"
#include "hirosco/pus/packet/packet.hpp"

namespace hirosco::testing {

/// Counts of what a subsystem has told its supervisor; events reach nobody here.
struct Told {
  int failures{0};     ///< TM[1,2], [1,4], ...
  std::string failed;  ///< of each: subtype and octets
  int completions{0};  ///< TM[1,7]
  int housekeeping{0};
  int reports{0};  ///< of an author's own services: types from 200

  /// All that waits in the channel. Thread: that of the test.
  void hear(Channel& channel) {
    MessageBuffer buffer;
    for (;;) {
      const auto found = channel.receive(buffer);
      if (!found || found->flow == Flow::None) return;
      if (found->message.kind == MessageKind::Event) continue;
      const auto view = pus::TelemetryView::parse(found->message.packet);
      ASSERT_TRUE(view);
      if (view->service() == 1 && view->subtype() % 2 == 0) {
        ++failures;
        failed += ' ' + std::to_string(view->subtype());
        for (const std::byte octet : view->source_data()) failed += ':' + std::to_string(static_cast<int>(octet));
      }
      if (view->service() == 1 && view->subtype() == 7) ++completions;
      if (view->service() == 3) ++housekeeping;
      if (view->service() >= 200) ++reports;
    }
  }
};

}  // namespace hirosco::testing
