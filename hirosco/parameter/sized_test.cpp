// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/parameter/sized.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <span>
#include <vector>

#include "hirosco/parameter/dictionary.hpp"

namespace hirosco {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using Axes = Sized<double, 4>;

/// Sized members of several types between others, so that lengths lie on odd places.
struct Sensed {
  std::uint8_t flags;
  Axes angle;
  Sized<std::uint8_t, 3> brake;
  float voltage;
};

static_assert(std::is_trivially_copyable_v<Axes>);
static_assert(ParameterValue<Axes>);
static_assert(ParameterValue<Sized<bool, 2>>);

ParameterSpec axes_of(std::uint16_t count, std::vector<Value> init = {}) {
  return {"AXES", {10, Type::Double, 0}, {{"AXES", Type::Double, count}}, false, std::move(init)};
}
ParameterSpec sensed_of(std::uint16_t axes, std::uint16_t brakes) {
  return {"SENSED",
          {10, Type::Struct, 0},
          {{"FLAGS", Type::Uint8, 1},
           {"ANGLE", Type::Double, axes},
           {"BRAKE", Type::Uint8, brakes},
           {"VOLTAGE", Type::Float, 1}},
          true,
          {}};
}
template <class T>
std::string refused_as(const ParameterSpec& spec) {
  Dictionary dictionary = Dictionary::make(std::vector{spec}).value();
  Parameter<T> parameter;
  const auto published = dictionary.publish(spec.name, parameter);
  return published ? "" : published.error();
}

TEST(Sized, HoldsAsManyElementsAsItIsGiven) {
  const Axes none;
  EXPECT_TRUE(none.empty());
  const Axes three{1, 2, 3};
  EXPECT_THAT(three, ElementsAre(1, 2, 3));
  EXPECT_EQ(std::accumulate(three.begin(), three.end(), 0.0), 6);
  EXPECT_EQ(std::span<const double>{three}.size(), 3u);
  EXPECT_EQ(three, Axes::of(std::vector{1.0, 2.0, 3.0}));
  EXPECT_FALSE(three == (Axes{1, 2}));
  EXPECT_THAT(Axes::zeros(2), ElementsAre(0, 0));
}

TEST(Sized, HasTheLengthThatItsDescriptorDeclaresWhateverIsStored) {
  for (std::uint16_t length = 1; length <= 4; ++length) {
    Dictionary dictionary = Dictionary::make(std::vector{axes_of(length)}).value();
    Parameter<Axes> parameter;
    ASSERT_TRUE(dictionary.publish("AXES", parameter));
    EXPECT_EQ(parameter.load().size(), length);
    EXPECT_EQ(dictionary.wire_octets(0), 8u * length);
    parameter.store({1, 2, 3, 4});
    const std::vector all{1.0, 2.0, 3.0, 4.0};
    EXPECT_THAT(parameter.load(), ElementsAreArray(std::span{all}.first(length))) << "a longer one is cut";
    parameter.store({7});
    std::vector filled(length, 0.0);
    filled[0] = 7;
    EXPECT_THAT(parameter.load(), ElementsAreArray(filled)) << "a shorter one is filled up";
    Axes seen;
    ASSERT_TRUE(parameter.snapshot(seen));
    EXPECT_THAT(seen, ElementsAreArray(filled));
  }
}

TEST(Sized, IsWrittenAndReadInItsLengthLikeAnyOtherArray) {
  Dictionary dictionary = Dictionary::make(std::vector{axes_of(3, {0.5, 1.5, 2.5})}).value();
  Parameter<Axes> parameter;
  ASSERT_TRUE(dictionary.publish("AXES", parameter));
  ASSERT_TRUE(dictionary.initialise());
  EXPECT_THAT(parameter.load(), ElementsAre(0.5, 1.5, 2.5));
  std::array<std::byte, 24> octets{};
  EXPECT_EQ(dictionary.snapshot_encode(0, -1, octets), 24u);
  OctetReader reader{octets};
  EXPECT_EQ(reader.get<double>(), 0.5);
  ASSERT_TRUE(dictionary.set(0, -1, {{3.0, 2.0, 1.0}}));
  EXPECT_THAT(parameter.load(), ElementsAre(3, 2, 1));
  EXPECT_FALSE(dictionary.set(0, -1, {{1.0, 2.0, 3.0, 4.0}}));
  EXPECT_FALSE(dictionary.accepts(0, -1, Octets{octets}.first(16)));
  ASSERT_TRUE(dictionary.decode_into(0, -1, octets));
  EXPECT_THAT(parameter.load(), ElementsAre(0.5, 1.5, 2.5));
}

TEST(Sized, MembersOfAStructureHaveLengthsOfTheirOwn) {
  Dictionary dictionary = Dictionary::make(std::vector{sensed_of(2, 3)}).value();
  Parameter<Sensed> parameter;
  ASSERT_TRUE(dictionary.publish("SENSED", parameter));
  EXPECT_EQ(dictionary.wire_octets(0), 1u + 16 + 3 + 4);
  parameter.store({5, {0.5, 1.5}, {1, 2, 3}, 24});
  std::array<std::byte, 24> octets{};
  ASSERT_EQ(dictionary.encode(0, -1, octets), octets.size());
  OctetReader reader{octets};
  EXPECT_EQ(reader.get<std::uint8_t>(), 5);
  EXPECT_EQ(reader.get<double>(), 0.5);
  EXPECT_EQ(reader.get<double>(), 1.5);
  for (const int brake : {1, 2, 3}) EXPECT_EQ(reader.get<std::uint8_t>(), brake);
  EXPECT_EQ(reader.get<float>(), 24.0F);
  const std::array<std::byte, 3> off{};
  ASSERT_TRUE(dictionary.decode_into(0, 2, off));
  EXPECT_THAT(parameter.load().brake, ElementsAre(0, 0, 0));
  EXPECT_THAT(parameter.load().angle, ElementsAre(0.5, 1.5));
}

TEST(Sized, KeepsItsLengthWhenItIsSetOctetByOctet) {
  Dictionary dictionary = Dictionary::make(std::vector{axes_of(2)}).value();
  Parameter<Axes> parameter;
  ASSERT_TRUE(dictionary.publish("AXES", parameter));
  const Axes longer{1, 2, 3, 4};
  ASSERT_TRUE(parameter.write_native(std::as_bytes(std::span{&longer, 1})));
  EXPECT_THAT(parameter.load(), ElementsAre(1, 2));
}

TEST(Sized, OfAnotherLengthOrTypeThanDeclaredIsRefusedWithBoth) {
  EXPECT_EQ(refused_as<Axes>(axes_of(4)), "");
  EXPECT_EQ(refused_as<Axes>(axes_of(5)),
            "AXES: the C++ type is Sized<double, 4>, the descriptor declares DOUBLE[5], which are more than 4");
  ParameterSpec floats = axes_of(2);
  floats.fields[0].type = floats.id.layout = Type::Float;
  EXPECT_EQ(refused_as<Axes>(floats), "AXES: the C++ type is Sized<double, 4>, the descriptor declares FLOAT[2]");
  EXPECT_EQ(refused_as<Sensed>(sensed_of(4, 3)), "");
  EXPECT_EQ(
      refused_as<Sensed>(sensed_of(4, 4)),
      "SENSED.BRAKE (member 3): the C++ type is Sized<std::uint8_t, 3>, the descriptor declares UINT8[4], which are "
      "more than 3");
}

TEST(Sized, TakesTheLengthOfItsNextDescriptor) {
  Parameter<Axes> parameter;
  for (const std::uint16_t length : std::array<std::uint16_t, 3>{4, 2, 3}) {
    Dictionary dictionary = Dictionary::make(std::vector{axes_of(length)}).value();
    ASSERT_TRUE(dictionary.publish("AXES", parameter));
    parameter.store({1, 2, 3, 4});
    EXPECT_EQ(parameter.load().size(), length);
  }
}

}  // namespace
}  // namespace hirosco
