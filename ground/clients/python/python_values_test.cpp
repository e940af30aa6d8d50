// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/clients/python/python_values.hpp"

#include <gtest/gtest.h>

namespace hirosco::ground {
namespace {

PythonValue angle() {
  PythonValue value{.field = {}, .fallback = std::nullopt, .texts = {}};
  value.field.name = "Q";
  value.field.unit = "rad";
  value.field.minimum = -2.0;
  value.field.maximum = 1.5;
  return value;
}

TEST(PythonValues, SayTypeUnitRangeAndWhatIsSentWhenLeftOut) {
  PythonValue value = angle();
  value.fallback = Value{Number{0.5}};
  EXPECT_EQ(field_call(value), R"(_r.Field("Q", "DOUBLE", unit="rad", minimum=-2, maximum=1.5, default=0.5))");
  EXPECT_EQ(described(value), "DOUBLE, rad, -2 to 1.5, 0.5 if left out");
  EXPECT_EQ(annotation(value), "float");
  value.field.count = 3;
  EXPECT_EQ(annotation(value), "_t.Sequence[float]");
}

TEST(PythonValues, OfTextSayHowLongItMayBe) {
  PythonValue value = angle();
  value.field = {};
  value.field.name = "TITLE";
  value.field.type = Type::Text;
  value.field.text_octets = 6;
  EXPECT_EQ(fields_tuple({value}), R"((_r.Field("TITLE", "TEXT", most=6),))");
  value.fixed = true;
  EXPECT_EQ(field_call(value), R"(_r.Field("TITLE", "TEXT", most=6, fixed=True))");
  EXPECT_EQ(annotation(value), "str");
}

TEST(PythonValues, WithNamesAreHintedByNameUntilThereAreTooMany) {
  PythonValue value = angle();
  value.field.type = Type::Uint8;
  value.texts = {{1, "red"}, {2, "gr\"een"}};
  EXPECT_EQ(pairs(value.texts), R"(((1, "red"), (2, "gr\"een"),))");
  EXPECT_EQ(annotation(value), R"(_t.Union[int, _t.Literal["red", "gr\"een"]])");
  value.texts.assign(17, {1, "red"});
  EXPECT_EQ(annotation(value), "_t.Union[int, str]");
}

}  // namespace
}  // namespace hirosco::ground
