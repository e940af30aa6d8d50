// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "lamp.hpp"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cmath>
#include <hirosco/subsystem/author/custom_service.hpp>
#include <hirosco/subsystem/author/module.hpp>
#include <optional>
#include <string_view>

namespace {

using namespace hirosco;

class Lamp final : public Subsystem {
  struct CurrentValues {  // CUR_VALUES in lamp.xml
    double brightness;
    double current_a;
  };
  struct Light {  // <Input> of the device
    double brightness;
  };
  struct Drive {  // its <Output>
    double current_a;
  };

  enum class Colour : std::uint8_t { White = 1, Amber = 2 };

  Result<> offline() override {
    meter_.on_request("READ_METER", [this](const Call& call) -> Result<> {
      CurrentValues now{};
      if (!current_.snapshot(now)) return fail(ErrorCode::Unavailable, "the lamp is being dimmed");
      return meter_.report("METER", call, dimmed_.load(), now.current_a);
    });
    meter_.on_request("LABEL", [this](std::string_view owner, std::uint64_t serial, bool lent, Call call) -> Result<> {
      return meter_.report("LABELLED", call, owner, serial, lent);
    });
    provide(meter_);
    return ok();
  }
  Result<Step> software_init() override {
    publish("CUR_VALUES", current_);
    use_device("LAMP", lamp_, {"BRIGHTEST"});
    on_function("DIM", [this](double brightness) -> Result<> {
      HIROSCO_TRY(aim_at(brightness));
      ++dimmed_;
      return ok();
    });
    use_event(programmed_);
    on_function("PROGRAM",
                [this](std::uint64_t serial, Colour colour, std::string_view note,
                       const std::array<float, 3>& steps) -> Result<> {
                  raise(programmed_, serial, colour, static_cast<std::uint8_t>(note.size()), steps);
                  return ok();
                });
    // As DIM, but ends when the light is there.
    on_function("FADE", [this](double brightness, Call call) -> Outcome {
      if (const Result<> aimed = aim_at(brightness); !aimed) return aimed;
      if (fading_) abort(*fading_, {ErrorCode::NotPermitted, "another fade took over"});
      fading_ = call;
      return running;
    });
    return done;
  }
  /// Each configuration, and each lamp of a mission, has a BRIGHTEST of its own.
  Result<> configure(const descriptor::Configuration&) override {
    const std::string_view given = lamp_.setting("BRIGHTEST");
    const char* const end = given.data() + given.size();
    double brightest = 0;
    const auto read = std::from_chars(given.data(), end, brightest);
    if (read.ec != std::errc{} || read.ptr != end || !(brightest > 0 && brightest <= 1))
      return fail(ErrorCode::InvalidArgument, "BRIGHTEST of LAMP is a number above 0, 1 at most");
    brightest_ = brightest;
    goal_ = std::min(goal_, brightest_);  // it was told perhaps when it might be brighter
    return ok();
  }
  Result<> aim_at(double brightness) noexcept {
    if (brightness > brightest_)
      return fail(ErrorCode::OutOfRange, "brighter than BRIGHTEST of this configuration of this lamp");
    goal_ = brightness;
    return ok();
  }

  Result<> operational(const Cycle& cycle) noexcept override {
    const double step = fade_per_s * seconds(cycle.period);
    double& current_a = lamp_.output().current_a;
    if (cycle.first) current_a = 0;  // it has been dark, whatever it was before
    current_a += std::clamp(goal_ - current_a, -step, step);
    current_.store({lamp_.input().brightness, current_a});
    if (fading_ && std::abs(lamp_.input().brightness - goal_) < close) {
      finish(*fading_);
      fading_.reset();
    }
    return ok();
  }

  static constexpr double fade_per_s = 1.0;
  static constexpr double close = 0.005;
  Parameter<CurrentValues> current_;
  DevicePort<Light, Drive> lamp_;
  Event<std::uint64_t, Colour, std::uint8_t, std::array<float, 3>> programmed_{"PROGRAMMED"};
  CustomService meter_{"METERING"};
  std::atomic<std::uint32_t> dimmed_{0};  // counted in the cycle, read in the service loop
  std::optional<Call> fading_;
  double brightest_{1};
  double goal_{0.2};
};

}  // namespace

std::unique_ptr<Subsystem> make_lamp() { return std::make_unique<Lamp>(); }

const hirosco::Module* hirosco_module() noexcept { return &hirosco::subsystem_module<make_lamp>; }
