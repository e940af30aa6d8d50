// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/link_slots.hpp"

#include <gtest/gtest.h>

namespace hirosco {
namespace {

struct Handed {
  double angle;
};

TEST(LinkSlot, AnInputTakesFieldsOfItsOwnTypeOnlyAndLetsGoOfItsOwnLinkOnly) {
  descriptor::Requires terms;
  terms.fields.resize(1);
  terms.fields[0].name = "ANGLE";
  terms.fields[0].type = Type::Double;
  terms.fields[0].count = 1;
  LinkInput<Handed> port;
  LinkInputSlot slot{terms, &port, true};
  AttachedLink link;
  const auto planned = [&](const char* name, Type type, std::uint16_t count) {
    link.agreement.kind = LinkKind::Latest;
    link.agreement.fields = {{"OTHER", Type::Uint8, 3}, {name, type, count}};
    return slot.plan(link).has_value();
  };
  EXPECT_FALSE(planned("ANGLES", Type::Double, 1));
  EXPECT_FALSE(planned("ANGLE", Type::Float, 1));
  EXPECT_FALSE(planned("ANGLE", Type::Double, 2));
  ASSERT_TRUE(planned("ANGLE", Type::Double, 1));
  ASSERT_EQ(link.wire_offset.size(), 1u);
  EXPECT_EQ(link.wire_offset[0], 3u) << "behind the three octets of the other";
  slot.attach(&link);
  const AttachedLink other;
  slot.detach(&other);
  EXPECT_TRUE(slot.attached());
  slot.detach(&link);
  EXPECT_FALSE(slot.attached());
  EXPECT_TRUE(slot.ended());
  slot.read(TimePoint{}, true);
  EXPECT_TRUE(slot.stale());
}

}  // namespace
}  // namespace hirosco
