// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "hirosco/subsystem/author/module.hpp"
#include "hirosco/subsystem/author/subsystem.hpp"

namespace {

using namespace hirosco;

class Imager final : public Subsystem {
  struct CurrentValues {
    double angle_rad;
    float temperature_c;
    float exposure_ms;
    std::uint32_t image;
    std::uint8_t brightness;
    std::uint8_t pointing_endnode;
    std::uint8_t image_endnode;
    std::uint32_t fall_backs;
  };
  struct Angle {
    double rad;
  };
  struct Rate {
    double rad_per_s;
  };
  struct Exposure {
    float ms;
  };
  struct Temperature {
    float c;
  };
  struct Image {
    std::uint32_t number;
    std::array<std::uint8_t, 64> pixels;
  };

  Result<Step> software_init() override {
    publish("CUR_VALUES", current_);
    use_device("IMAGER.POINTING", pointing_);
    use_device("IMAGER.COMMAND", command_);
    use_device("IMAGER.STATUS", status_);
    use_device("IMAGER.IMAGE", image_);
    on_function("POINT", [this](double angle_rad) -> Result<> {
      goal_rad_ = angle_rad;
      return ok();
    });
    on_function("EXPOSE", [this](float time_ms) -> Result<> {
      command_.output().ms = time_ms;
      return ok();
    });
    return done;
  }

  Result<> safe_operational(const Cycle& cycle) noexcept override {
    goal_rad_ = pointing_.input().rad;
    return operational(cycle);
  }

  Result<> operational(const Cycle&) noexcept override {
    constexpr double gain_per_s = 4, fastest_rad_per_s = 0.2;
    const double rate = gain_per_s * (goal_rad_ - pointing_.input().rad);
    pointing_.output().rad_per_s = std::clamp(rate, -fastest_rad_per_s, fastest_rad_per_s);
    const Image& image = image_.input();
    current_.store({pointing_.input().rad, status_.input().c, command_.input().ms, image.number, image.pixels[0],
                    pointing_.endnode(), image_.endnode(), pointing_.fall_backs() + image_.fall_backs()});
    return ok();
  }

  Parameter<CurrentValues> current_;
  DevicePort<Angle, Rate> pointing_;
  DevicePort<Exposure, Exposure> command_;
  DevicePort<Temperature, NoFields> status_;
  DevicePort<Image, NoFields> image_;
  double goal_rad_{0};
};

std::unique_ptr<Subsystem> make_imager() { return std::make_unique<Imager>(); }

}  // namespace

const hirosco::Module* hirosco_module() noexcept { return &hirosco::subsystem_module<make_imager>; }
