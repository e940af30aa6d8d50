// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/parameter/text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <type_traits>
#include <vector>

#include "hirosco/parameter/dictionary.hpp"

namespace hirosco {
namespace {

using ::testing::HasSubstr;

struct Camera {
  bool on;
  Text<8> filter;
  std::array<bool, 3> shutters;
  double exposure;
};
static_assert(std::is_trivially_copyable_v<Text<8>>);
static_assert(sizeof(Text<8>) == 8);
static_assert(layout_of<Camera>() == std::array{NativeField{Type::Bool, 1, 0}, NativeField{Type::Text, 8, 1},
                                                NativeField{Type::Bool, 3, 9}, NativeField{Type::Double, 1, 16}});

ParameterSpec camera() {
  return {
      "CAMERA",
      {10, Type::Struct, 0},
      {{"ON", Type::Bool, 1}, {"FILTER", Type::Text, 8}, {"SHUTTERS", Type::Bool, 3}, {"EXPOSURE", Type::Double, 1}},
      true,
      {true, "red", false, true, 1, 0.5}};
}
std::vector<std::byte> octets_of_text(std::string_view text) {
  const auto octets = std::as_bytes(std::span{text});
  return {octets.begin(), octets.end()};
}

TEST(Text, HasItsWordsAndNothingButZerosBehindThem) {
  Text<8> text = "longest";
  text = std::string_view{"ab"};
  EXPECT_EQ(text.view(), "ab");
  EXPECT_EQ(text, "ab");
  EXPECT_EQ(text, Text<8>{"ab"}) << "octets of the words before are gone";
  EXPECT_TRUE(Text<8>{}.empty());
  text = std::string_view{};
  EXPECT_TRUE(text.empty());
  EXPECT_EQ(Text<4>{"four"}.view(), "four") << "no octet is kept for an end";
}

TEST(Text, IsCutBehindAWholeCharacter) {
  EXPECT_EQ(Text<4>{std::string_view{"abc\xC3\xA9"}}.view(), "abc");
  EXPECT_EQ(Text<5>{std::string_view{"abc\xC3\xA9"}}.view(), "abc\xC3\xA9");
  EXPECT_EQ(Text<4>{std::string_view{"ab\xFFzz"}}.view(), "ab") << "no UTF-8";
  EXPECT_EQ((Text<4>{std::string_view{"a\0b", 3}}.view()), "a");
}

TEST(Text, TakesItsOwnWords) {
  Text<8> text = "abcdef";
  text = text.view().substr(2);
  EXPECT_EQ(text, "cdef");
}

TEST(Text, OnTheWireIsOneOfItsSizeOnly) {
  using namespace std::string_view_literals;
  EXPECT_TRUE(is_fixed_text(octets_of_text("abc\0\0"sv)));
  EXPECT_TRUE(is_fixed_text(octets_of_text("\0\0"sv)));
  EXPECT_TRUE(is_fixed_text(octets_of_text("\xC3\xA9"sv)));
  EXPECT_FALSE(is_fixed_text(octets_of_text("abc\0d"sv))) << "something behind its end";
  EXPECT_FALSE(is_fixed_text(octets_of_text("ab\xC3\0"sv))) << "half a character";
  EXPECT_EQ(fixed_words(octets_of_text("ab\0c"sv)), "ab");
}

class CameraParameter : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(dictionary_.publish("CAMERA", camera_));
    ASSERT_TRUE(dictionary_.initialise());
  }
  [[nodiscard]] std::vector<std::byte> encoded() const {
    std::vector<std::byte> octets(dictionary_.wire_octets(0));
    EXPECT_EQ(dictionary_.encode(0, -1, octets), octets.size());
    return octets;
  }
  Dictionary dictionary_ = Dictionary::make(std::vector{camera()}).value();
  Parameter<Camera> camera_;
};

TEST_F(CameraParameter, BeginsAsItIsDeclared) {
  EXPECT_TRUE(camera_.load().on);
  EXPECT_EQ(camera_.load().filter, "red");
  EXPECT_EQ(camera_.load().shutters, (std::array{false, true, true}));
  EXPECT_EQ(camera_.load().exposure, 0.5);
}

TEST_F(CameraParameter, StandsOnTheWireWithoutGapsAndWithZerosBehindWords) {
  using namespace std::string_view_literals;
  auto wanted = octets_of_text("\x01red\0\0\0\0\0\0\x01\x01"sv);
  wanted.resize(20);
  OctetWriter{MutableOctets{wanted}.subspan(12)}.put(0.5);
  EXPECT_EQ(encoded(), wanted);
  std::vector<std::byte> snapshot(20);
  EXPECT_EQ(dictionary_.snapshot_encode(0, -1, snapshot), 20U);
  EXPECT_EQ(snapshot, wanted);
}

TEST_F(CameraParameter, ComesBackFromTheWireAsItWas) {
  const auto octets = encoded();
  camera_.store({});
  ASSERT_TRUE(dictionary_.decode_into(0, -1, octets));
  EXPECT_EQ(encoded(), octets);
  EXPECT_EQ(camera_.load().filter, Text<8>{"red"});
}

TEST_F(CameraParameter, RefusesASwitchThatIsNeitherAndATextThatIsNone) {
  auto octets = encoded();
  for (const std::size_t place : {0U, 9U, 11U}) {
    auto wrong = octets;
    wrong[place] = std::byte{2};
    EXPECT_EQ(dictionary_.accepts(0, -1, wrong).error().code, ErrorCode::OutOfRange) << place;
    EXPECT_FALSE(dictionary_.decode_into(0, -1, wrong)) << place;
  }
  octets[8] = std::byte{'x'};  // behind the zeros
  EXPECT_EQ(dictionary_.decode_into(0, -1, octets).error().code, ErrorCode::OutOfRange);
  octets[8] = std::byte{0};
  octets[1] = std::byte{0xFF};
  EXPECT_FALSE(dictionary_.decode_into(0, -1, octets));
  EXPECT_TRUE(camera_.load().on) << "nothing changed";
  EXPECT_EQ(camera_.load().filter, "red");
}

TEST_F(CameraParameter, IsSetFromValuesOfItsTypesOnly) {
  EXPECT_TRUE(dictionary_.set(0, 1, {{Value{"green"}}}));
  EXPECT_EQ(camera_.load().filter, "green");
  EXPECT_TRUE(dictionary_.set(0, 1, {{Value{""}}}));
  EXPECT_EQ(camera_.load().filter, Text<8>{}) << "nothing is left of longer words";
  EXPECT_FALSE(dictionary_.set(0, 1, {{Value{"ultraviolet"}}})) << "longer than it holds";
  EXPECT_FALSE(dictionary_.set(0, 1, {{Value{7}}}));
  EXPECT_FALSE(dictionary_.set(0, 0, {{Value{"on"}}}));
  EXPECT_FALSE(dictionary_.set(0, 0, {{Value{2}}}));
  EXPECT_TRUE(dictionary_.set(0, 0, {{Value{false}}}));
  EXPECT_FALSE(camera_.load().on);
}

TEST(TextParameter, OfAnotherSizeOrTypeIsRefusedInWords) {
  const ParameterSpec spec{"NAME", {10, Type::Text, 0}, {{"NAME", Type::Text, 20}}, false, {}};
  const auto refusal_of = [&](ParameterCell& cell) {
    Dictionary dictionary = Dictionary::make(std::vector{spec}).value();
    return dictionary.publish("NAME", cell).error();
  };
  Parameter<Text<19>> shorter;
  EXPECT_EQ(refusal_of(shorter), "NAME: the C++ type is Text<19>, the descriptor declares TEXT of 20 octets");
  Parameter<std::array<std::uint8_t, 20>> octets;
  EXPECT_EQ(refusal_of(octets),
            "NAME: the C++ type is std::array<std::uint8_t, 20>, the descriptor declares TEXT of 20 octets");
  const ParameterSpec on{"ON", {10, Type::Bool, 0}, {{"ON", Type::Bool, 1}}, false, {}};
  Dictionary dictionary = Dictionary::make(std::vector{on}).value();
  Parameter<std::uint8_t> number;
  EXPECT_EQ(dictionary.publish("ON", number).error(), "ON: the C++ type is std::uint8_t, the descriptor declares BOOL");
}

TEST(TextParameter, IsDeclaredWithAtMost254Octets) {
  const auto made =
      Dictionary::make(std::vector{ParameterSpec{"NAME", {10, Type::Text, 0}, {{"NAME", Type::Text, 255}}, false, {}}});
  EXPECT_THAT(made.error(), HasSubstr("at most 254"));
}

}  // namespace
}  // namespace hirosco
