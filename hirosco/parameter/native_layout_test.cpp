// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/parameter/native_layout.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>

namespace hirosco {
namespace {

enum class Phase : std::uint16_t { Idle, Moving };
enum class Flag : bool { No, Yes };

// Listing 1 of the paper, and a mixture that needs padding in three places.
struct CurrentValues {
  std::int32_t moving;
  std::array<double, 2> position;
  std::array<double, 2> torque;
};
struct Mixed {
  std::uint8_t a;
  double b;
  Phase c;
  float d;
  std::array<std::int8_t, 3> e;
  std::uint64_t f;
  std::int16_t g;
};
struct Sixteen {
  std::uint8_t a;
  std::int16_t b;
  std::uint32_t c;
  std::int64_t d;
  float e;
  double f;
  std::int8_t g;
  std::uint16_t h;
  std::int32_t i;
  std::uint64_t j;
  std::uint8_t k;
  std::uint8_t l;
  std::uint8_t m;
  std::uint8_t n;
  double o;
  float p;
};

static_assert(layout_of<double>() == std::array{NativeField{Type::Double, 1, 0}});
static_assert(layout_of<Phase>() == std::array{NativeField{Type::Uint16, 1, 0}});
static_assert(layout_of<std::array<float, 7>>() == std::array{NativeField{Type::Float, 7, 0}});

// What must not compile when used, asked as a question.
static_assert(layout_of<bool>() == std::array{NativeField{Type::Bool, 1, 0}});
static_assert(layout_of<std::array<bool, 2>>() == std::array{NativeField{Type::Bool, 2, 0}});
static_assert(layout_of<Text<20>>() == std::array{NativeField{Type::Text, 20, 0}});
static_assert(!ParameterValue<std::array<Text<4>, 2>>, "an array of texts is not declared either");
static_assert(!ParameterValue<Flag>);
static_assert(!ParameterValue<char>);
static_assert(!ParameterValue<long double>);
static_assert(!ParameterValue<double*>);
static_assert(!ParameterValue<double[2]>);
static_assert(ParameterValue<Phase>);
static_assert(ParameterValue<long>);

TEST(Layout, OfEveryNumberIsItsType) {
  EXPECT_EQ(layout_of<std::uint8_t>()[0].type, Type::Uint8);
  EXPECT_EQ(layout_of<std::int8_t>()[0].type, Type::Int8);
  EXPECT_EQ(layout_of<std::uint16_t>()[0].type, Type::Uint16);
  EXPECT_EQ(layout_of<std::int16_t>()[0].type, Type::Int16);
  EXPECT_EQ(layout_of<std::uint32_t>()[0].type, Type::Uint32);
  EXPECT_EQ(layout_of<std::int32_t>()[0].type, Type::Int32);
  EXPECT_EQ(layout_of<std::uint64_t>()[0].type, Type::Uint64);
  EXPECT_EQ(layout_of<std::int64_t>()[0].type, Type::Int64);
  EXPECT_EQ(layout_of<float>()[0].type, Type::Float);
  EXPECT_EQ(layout_of<double>()[0].type, Type::Double);
}

TEST(Layout, OfAStructureHasTheCompilersOwnOffsets) {
  constexpr auto fields = layout_of<Mixed>();
  ASSERT_EQ(fields.size(), 7u);
  EXPECT_EQ(fields[0], (NativeField{Type::Uint8, 1, offsetof(Mixed, a)}));
  EXPECT_EQ(fields[1], (NativeField{Type::Double, 1, offsetof(Mixed, b)}));
  EXPECT_EQ(fields[2], (NativeField{Type::Uint16, 1, offsetof(Mixed, c)}));
  EXPECT_EQ(fields[3], (NativeField{Type::Float, 1, offsetof(Mixed, d)}));
  EXPECT_EQ(fields[4], (NativeField{Type::Int8, 3, offsetof(Mixed, e)}));
  EXPECT_EQ(fields[5], (NativeField{Type::Uint64, 1, offsetof(Mixed, f)}));
  EXPECT_EQ(fields[6], (NativeField{Type::Int16, 1, offsetof(Mixed, g)}));
}

TEST(Layout, TakesArraysAsSingleFields) {
  constexpr auto fields = layout_of<CurrentValues>();
  ASSERT_EQ(fields.size(), 3u);
  EXPECT_EQ(fields[1], (NativeField{Type::Double, 2, offsetof(CurrentValues, position)}));
  EXPECT_EQ(fields[2], (NativeField{Type::Double, 2, offsetof(CurrentValues, torque)}));
}

TEST(Layout, ReachesSixteenMembers) {
  constexpr auto fields = layout_of<Sixteen>();
  ASSERT_EQ(fields.size(), 16u);
  EXPECT_EQ(fields[9], (NativeField{Type::Uint64, 1, offsetof(Sixteen, j)}));
  EXPECT_EQ(fields[15], (NativeField{Type::Float, 1, offsetof(Sixteen, p)}));
}

template <std::size_t N>
struct Counted;
#define MEMBERS(n, ...)        \
  template <>                  \
  struct Counted<n> {          \
    std::uint16_t __VA_ARGS__; \
  };
MEMBERS(1, a)
MEMBERS(2, a, b)
MEMBERS(3, a, b, c)
MEMBERS(4, a, b, c, d)
MEMBERS(5, a, b, c, d, e)
MEMBERS(6, a, b, c, d, e, f)
MEMBERS(7, a, b, c, d, e, f, g)
MEMBERS(8, a, b, c, d, e, f, g, h)
MEMBERS(9, a, b, c, d, e, f, g, h, i)
MEMBERS(10, a, b, c, d, e, f, g, h, i, j)
MEMBERS(11, a, b, c, d, e, f, g, h, i, j, k)
MEMBERS(12, a, b, c, d, e, f, g, h, i, j, k, l)
MEMBERS(13, a, b, c, d, e, f, g, h, i, j, k, l, m)
MEMBERS(14, a, b, c, d, e, f, g, h, i, j, k, l, m, n)
MEMBERS(15, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o)
MEMBERS(16, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p)
#undef MEMBERS

template <std::size_t N>
void expect_layout_of_members() {
  const auto fields = layout_of<Counted<N>>();
  ASSERT_EQ(fields.size(), N);
  for (std::size_t i = 0; i < N; ++i) EXPECT_EQ(fields[i], (NativeField{Type::Uint16, 1, 2 * i})) << N;
}

TEST(Layout, CountsEveryNumberOfMembers) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (expect_layout_of_members<I + 1>(), ...);
  }(std::make_index_sequence<16>{});
}

struct Gains {
  double p;
  float damping;
};
struct Joint {
  std::uint8_t number;
  Gains gains;
  bool braked;
};
struct Controller {
  std::uint16_t mode;
  std::array<Joint, 2> joints;
  Gains tip;
  Text<5> note;
};

TEST(Layout, OfAStructureWithinAndOfAnArrayOfThemIsTheirValuesWhereTheyLie) {
  constexpr auto fields = layout_of<Controller>();
  constexpr std::size_t first = offsetof(Controller, joints), second = first + sizeof(Joint);
  constexpr std::size_t tip = offsetof(Controller, tip), in_joint = offsetof(Joint, gains);
  const std::array expected{NativeField{Type::Uint16, 1, 0},
                            NativeField{Type::Uint8, 1, first},
                            NativeField{Type::Double, 1, first + in_joint},
                            NativeField{Type::Float, 1, first + in_joint + offsetof(Gains, damping)},
                            NativeField{Type::Bool, 1, first + offsetof(Joint, braked)},
                            NativeField{Type::Uint8, 1, second},
                            NativeField{Type::Double, 1, second + in_joint},
                            NativeField{Type::Float, 1, second + in_joint + offsetof(Gains, damping)},
                            NativeField{Type::Bool, 1, second + offsetof(Joint, braked)},
                            NativeField{Type::Double, 1, tip},
                            NativeField{Type::Float, 1, tip + offsetof(Gains, damping)},
                            NativeField{Type::Text, 5, offsetof(Controller, note)}};
  EXPECT_EQ(fields, expected);
}

struct Chain {
  std::uint8_t length;
  Sized<float, 4> angles;
};
struct Chains {
  std::array<Chain, 2> chains;
};

TEST(Layout, OfASizedArrayInAnArrayOfStructuresHasItsLength) {
  constexpr auto fields = layout_of<Chains>();
  ASSERT_EQ(fields.size(), 4u);
  EXPECT_EQ(fields[3].offset, sizeof(Chain) + offsetof(Chain, angles));
  EXPECT_EQ(fields[3].most, 4);
}

TEST(Layout, HasATextForMessages) {
  EXPECT_EQ(cpp_text({Type::Double, 1, 0}), "double");
  EXPECT_EQ(cpp_text({Type::Int32, 4, 0}), "std::array<std::int32_t, 4>");
  EXPECT_EQ(descriptor_text(Type::Double, 2), "DOUBLE[2]");
  EXPECT_EQ(descriptor_text(Type::Uint8, 1), "UINT8");
}

}  // namespace
}  // namespace hirosco
