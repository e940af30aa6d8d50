// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <numeric>

#include "hirosco/subsystem/author/module.hpp"
#include "hirosco/subsystem/author/subsystem.hpp"

namespace {

using namespace hirosco;

/// Sums up the light of each image where it lies, an eighth of it in a cycle; what it summed counts when the image was still that one.
class Viewer final : public Subsystem {
  struct Image {  // VIEW in viewer.xml
    std::uint32_t number;
    std::uint16_t width, height, x, y;
    std::uint8_t binning, shutter;
    float exposure_ms;
    std::array<std::uint8_t, 1U << 20> pixel;
  };
  struct Seen {
    std::uint32_t number;
    std::uint64_t light;
    std::uint32_t whole, overtaken;
  };

  Result<Step> software_init() override {
    publish("SEEN", seen_);
    require_link("VIEW", view_);
    on_function("EXPECT", [this](std::uint32_t whole) -> Outcome {
      if (seen_.load().whole < whole)
        return Result<>{fail(ErrorCode::NotPermitted, "images were seen whole", seen_.load().whole)};
      return Result<>{};
    });
    return done;
  }
  Result<> operational(const Cycle&) noexcept override {
    if (view_.age_cycles() == 0 && view_.count() != 0) begin();
    if (image_ == nullptr || !view_.whole()) {
      give_up();
      return ok();
    }
    const std::size_t pixels = std::min(std::size_t{image_->width} * image_->height, image_->pixel.size());
    const std::size_t end = std::min(at_ + image_->pixel.size() / 8, pixels);
    sum_ = std::accumulate(image_->pixel.begin() + static_cast<std::ptrdiff_t>(at_),
                           image_->pixel.begin() + static_cast<std::ptrdiff_t>(end), sum_);
    at_ = end;
    if (at_ < pixels) return ok();
    const std::uint32_t number = image_->number;
    if (!view_.whole()) {
      give_up();
      return ok();
    }
    image_ = nullptr;
    const Seen before = seen_.load();
    seen_.store({number, sum_, before.whole + 1, before.overtaken});
    return ok();
  }
  void begin() noexcept {
    give_up();
    image_ = view_.look();
    at_ = 0;
    sum_ = 0;
  }
  void give_up() noexcept {
    if (std::exchange(image_, nullptr) == nullptr) return;
    Seen seen = seen_.load();
    ++seen.overtaken;
    seen_.store(seen);
  }

  LoanInput<Image> view_;
  Parameter<Seen> seen_;
  const Image* image_{nullptr};
  std::size_t at_{0};
  std::uint64_t sum_{0};
};

std::unique_ptr<Subsystem> make_viewer() { return std::make_unique<Viewer>(); }

}  // namespace

const hirosco::Module* hirosco_module() noexcept { return &hirosco::subsystem_module<make_viewer>; }
