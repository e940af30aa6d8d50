// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/communication/telemetry_ring.hpp"

#include <gtest/gtest.h>

#include <span>
#include <string>

namespace hirosco::communication {
namespace {

struct RingOfTen : ::testing::Test {
  TelemetryRing ring{10};
  void put(const std::string& text) { ring.put(std::as_bytes(std::span{text})); }
  /// All that follows for a reader, piece by piece.
  std::string read(std::uint64_t& read_to) const {
    std::string text;
    for (Octets piece = ring.after(read_to); !piece.empty(); piece = ring.after(read_to)) {
      text.append(reinterpret_cast<const char*>(piece.data()), piece.size());
      read_to += piece.size();
    }
    return text;
  }
};

TEST_F(RingOfTen, IsReadByEachAtItsOwnPace) {
  std::uint64_t quick = 0, slow = 0;
  put("abcd");
  EXPECT_EQ(read(quick), "abcd");
  EXPECT_EQ(read(quick), "");
  put("ef");
  EXPECT_EQ(read(quick), "ef");
  EXPECT_EQ(read(slow), "abcdef");
}

TEST_F(RingOfTen, GoesOnAtItsBeginWherePacketsPassItsEnd) {
  std::uint64_t reader = 0;
  for (const std::string packet : {"abcdefg", "hijklmn", "opqrstuvwx"}) {
    put(packet);
    EXPECT_EQ(read(reader), packet);
  }
  EXPECT_EQ(ring.written(), 24U);
}

}  // namespace
}  // namespace hirosco::communication
