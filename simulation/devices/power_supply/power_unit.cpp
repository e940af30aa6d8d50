// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/power_supply/power_unit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace hirosco::simulation {
namespace {

constexpr double full_sun_w = 900;
constexpr double capacity_w_h = 600, most_charging_w = 300;
/// Of the battery, and so of the bus: empty and full.
constexpr double empty_v = 24, full_v = 32;
constexpr double seconds_an_hour = 3600;

}  // namespace

PowerUnit::PowerUnit(FlowFactory& flows, FlowAddress address, const Settings& settings)
    : SimulatedDevice{flows, std::move(address), settings} {}

double PowerUnit::array_w() const noexcept {
  if (eclipse_) return 0;
  return cells_ * full_sun_w * std::max(0.0, std::cos(sun_angle_deg_ * std::numbers::pi / 180));
}

double PowerUnit::loads_w() const noexcept { return platform_w_ + (payload_on_ ? payload_w_ : 0); }

double PowerUnit::bus_v() const noexcept {
  if (charge_ <= 0 && array_w() < loads_w()) return 0;
  return empty_v + (full_v - empty_v) * charge_;
}

void PowerUnit::advance(Duration cycle) noexcept {
  const double left_w = std::min(array_w() - loads_w(), most_charging_w);
  charge_ = std::clamp(charge_ + left_w * seconds(cycle) / (capacity_w_h * seconds_an_hour), 0.0, 1.0);
}

Result<> PowerUnit::take(OctetReader payload) noexcept {
  const auto on = payload.get<std::uint8_t>();
  if (!payload.exhausted()) return fail(ErrorCode::Malformed, "outlet command size");
  payload_on_ = on != 0;
  return ok();
}

void PowerUnit::write_sensors(OctetWriter& payload) noexcept {
  const double volts = bus_v();
  const auto amperes = [&](double watts) { return volts > 0 ? watts / volts : 0.0; };
  payload.put(array_w()).put(sun_angle_deg_).put(charge_).put(volts);
  payload.put(amperes(platform_w_)).put(amperes(payload_on_ ? payload_w_ : 0));
  payload.put(static_cast<std::uint8_t>(eclipse_ ? 1 : 0));
}

Result<> PowerUnit::do_fault(const Words& words) {
  constexpr double most_w = 10'000;
  HIROSCO_TRY(words.expect(2));
  if (words[0] == "eclipse") {
    if (words[1] != "on" && words[1] != "off") return fail(ErrorCode::InvalidArgument, "eclipse on or off");
    eclipse_ = words[1] == "on";
    return ok();
  }
  const auto set = [&](double& value, double least, double most) -> Result<> {
    HIROSCO_TRY_LET(value, words.number(1, least, most));
    return ok();
  };
  if (words[0] == "sun_angle") return set(sun_angle_deg_, 0, 180);
  if (words[0] == "charge") return set(charge_, 0, 1);
  if (words[0] == "array") return set(cells_, 0, 1);
  if (words[0] == "platform_load") return set(platform_w_, 0, most_w);
  if (words[0] == "payload_load") return set(payload_w_, 0, most_w);
  return fail(ErrorCode::InvalidArgument, "unknown fault");
}

std::string PowerUnit::do_truth() const {
  return fmt::format(
      "array_w={:.3f} sun_angle={:.3f} eclipse={} charge={:.6f} bus_v={:.3f} loads_w={:.3f} payload_on={}", array_w(),
      sun_angle_deg_, eclipse_ ? 1 : 0, charge_, bus_v(), loads_w(), payload_on_ ? 1 : 0);
}

/// Cells come back and the sun shines; where it stands, what is charged and what is drawn is no fault.
void PowerUnit::do_heal() noexcept {
  eclipse_ = false;
  cells_ = 1;
}

}  // namespace hirosco::simulation
