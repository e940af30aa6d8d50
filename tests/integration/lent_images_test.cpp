// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "tests/integration/two_ends.hpp"

/// A camera lends images of a mebioctet to a viewer, 30 a second, in a whole spacecraft: supervisor, handshake, cycles, death.
namespace hirosco::testing {
namespace {

struct Image {
  std::uint64_t number;
  std::uint16_t width;
  std::uint16_t height;
  std::array<std::uint8_t, 1U << 20> pixel;
};

constexpr std::string_view image_fields =
    R"(<Field name="NUMBER" type="UINT64"/><Field name="WIDTH" type="UINT16"/><Field name="HEIGHT" type="UINT16"/>
       <Field name="PIXEL" type="UINT8" count="1048576"/>)";

std::string descriptor_of(std::string_view name, int id, std::string_view set) {
  std::string text = "<Subsystem name=\"" + std::string{name} + "\" id=\"" + std::to_string(id) + "\">";
  text += R"(<Configuration name="IMAGES" id="1" sampling_us="1000"><RealTimeLinkService>)";
  text.append(set).append(image_fields).append(set.starts_with("<Provides") ? "</Provides>" : "</Requires>");
  return text + "</RealTimeLinkService></Configuration></Subsystem>";
}

/// Makes an image row by row: 33 cycles for 1024 rows.
struct Camera final : Subsystem {
  LoanOutput<Image> image;
  std::uint64_t made{0};

 protected:
  Result<Step> software_init() override {
    lend_link("IMAGE", image);
    return done;
  }
  Result<> pre_operational(const Cycle&) noexcept override { return expose(); }
  Result<> safe_operational(const Cycle&) noexcept override { return expose(); }
  Result<> operational(const Cycle&) noexcept override { return expose(); }

 private:
  static constexpr std::size_t row_octets = 1024;
  static constexpr std::size_t rows_a_cycle = 32;
  Result<> expose() noexcept {
    Image* const place = image.lend();
    if (place != begun_) row_ = 0;
    begun_ = place;
    if (place == nullptr) return ok();
    const auto value = static_cast<std::uint8_t>(made + 1);
    for (std::size_t i = 0; i < rows_a_cycle && row_ < 1024; ++i, ++row_)
      std::fill_n(place->pixel.begin() + static_cast<std::ptrdiff_t>(row_ * row_octets), row_octets, value);
    if (row_ < 1024) return ok();
    place->number = ++made;
    place->width = place->height = 1024;
    image.publish();
    begun_ = nullptr;
    return ok();
  }
  Image* begun_{nullptr};
  std::size_t row_{0};
};

struct Viewer final : Subsystem {
  LoanInput<Image> view;
  std::uint64_t whole{0}, wrong{0}, overtaken{0}, newest{0};

 protected:
  Result<Step> software_init() override {
    require_link("VIEW", view);
    return done;
  }
  Result<> pre_operational(const Cycle&) noexcept override { return look(); }
  Result<> safe_operational(const Cycle&) noexcept override { return look(); }
  Result<> operational(const Cycle&) noexcept override { return look(); }

 private:
  Result<> look() noexcept {
    if (view.age_cycles() != 0 || view.count() == 0) return ok();
    const Image* const image = view.look();
    if (image == nullptr) return ok();
    const std::uint64_t number = image->number;
    const bool right =
        std::ranges::all_of(image->pixel, [&](std::uint8_t p) { return p == static_cast<std::uint8_t>(number); });
    if (!view.whole()) {
      ++overtaken;
      return ok();
    }
    ++whole;
    wrong += right ? 0 : 1;
    newest = number;
    return ok();
  }
};

struct LentImages : ::testing::Test {
  Camera* camera{nullptr};
  Viewer* viewer{nullptr};
  Flight flight{
      two_ends({"CAMERA", "IMAGES", "IMAGE", descriptor_of("CAMERA", 20, R"(<Provides name="IMAGE" kind="loaned">)"),
                making(camera)},
               {"VIEWER", "IMAGES", "VIEW",
                descriptor_of("VIEWER", 21, R"(<Requires name="VIEW" kind="loaned" age="100">)"), making(viewer)},
               "", R"(<Permit subsystem="VIEWER" functions="SET_STATE"/>)")};

  /// The viewer is Operational before the first image is there and inhibited for it: it goes there again with images.
  void SetUp() override {
    ASSERT_TRUE(flight.commission()) << flight.story().text();
    EXPECT_NE(flight.inhibited("VIEWER"), 0U);
    flight.craft().run(100ms);
    for (const State state : {State::SafeOperational, State::Operational})
      ASSERT_TRUE(flight.set_state("VIEWER", state).completed) << flight.story().text();
    ASSERT_EQ(flight.inhibited("VIEWER"), 0U);
  }
};

TEST_F(LentImages, ReachTheirViewerWholeThirtyTimesASecond) {
  flight.craft().run(100ms);
  const std::uint64_t before = viewer->whole, made = camera->made;
  flight.craft().run(1s);
  EXPECT_GE(viewer->whole - before, 29U);
  EXPECT_NEAR(static_cast<double>(viewer->whole - before), static_cast<double>(camera->made - made), 1.0);
  EXPECT_EQ(viewer->wrong, 0U);
  EXPECT_EQ(viewer->overtaken, 0U);
  EXPECT_TRUE(viewer->view.valid());
  EXPECT_EQ(flight.state("VIEWER"), State::Operational);
  EXPECT_EQ(flight.inhibited("VIEWER"), 0U);
}

TEST_F(LentImages, OfACameraThatDiesInTheMiddleOfOneAreReliedOnNoLonger) {
  flight.craft().run(110ms);
  ASSERT_TRUE(viewer->view.valid());
  flight.craft().kill("CAMERA");
  camera = nullptr;
  flight.craft().run(500ms);
  EXPECT_FALSE(viewer->view.valid());
  EXPECT_EQ(viewer->wrong, 0U);
  EXPECT_TRUE(flight.state("VIEWER") != State::Operational || flight.inhibited("VIEWER") != 0) << flight.story().text();
  EXPECT_TRUE(flight.story().has("CAMERA died")) << flight.story().text();
}

TEST_F(LentImages, OfACameraThatStandsStillGetOldAndInhibitTheirViewer) {
  flight.craft().run(110ms);
  ASSERT_EQ(flight.inhibited("VIEWER"), 0U);
  const std::uint64_t newest = viewer->newest;
  flight.craft().stop("CAMERA", true);
  ASSERT_TRUE(flight.craft().run_until([&] { return !viewer->view.valid(); }, 200ms)) << flight.story().text();
  flight.craft().run(1ms);
  EXPECT_NE(flight.inhibited("VIEWER"), 0U);
  EXPECT_EQ(viewer->newest, newest);
  EXPECT_EQ(viewer->wrong, 0U);
}

}  // namespace
}  // namespace hirosco::testing
