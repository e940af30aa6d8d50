// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/thermal/thermal_unit.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace hirosco::simulation {
namespace {

constexpr double heater_w = 10, inside_w = 3, sunlit_w = 2;
constexpr double radiating_m2 = 0.02, capacity_j_k = 3000;
constexpr float dead_c = -273.15F;
constexpr double coldest_c = -200, hottest_c = 300;

[[nodiscard]] double number_in(std::string_view text, bool& good) noexcept {
  double value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  good = good && problem == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
  return value;
}

}  // namespace

ThermalUnit::ThermalUnit(FlowFactory& flows, FlowAddress address, const Settings& settings)
    : SimulatedDevice{flows, std::move(address), settings}, random_{settings.seed} {
  std::array<ThermalNode, most_zones> nodes{};
  nodes.fill({.capacity_j_k = capacity_j_k, .radiating_m2 = radiating_m2});
  network_.begin(nodes);
  heater_w_.fill(heater_w);
  inside_w_.fill(inside_w);
  sunlit_w_.fill(sunlit_w);
  couple();
}

void ThermalUnit::couple() noexcept {
  for (std::size_t i = 1; i < count(); ++i) network_.couple(i - 1, i, neighbours_w_k_);
}

bool ThermalUnit::heats(std::size_t zone) const noexcept {
  const Zone& is = zones_[zone];
  if (!is.line || is.heater == HeaterFault::StuckOff) return false;
  if (is.heater == HeaterFault::StuckOn) return true;
  return own_ || !active() ? is.own_on : is.on;
}

double ThermalUnit::drawn_w() const noexcept {
  double sum_w = 0;
  for (std::size_t i = 0; i < count(); ++i) sum_w += heats(i) ? heater_w_[i] : 0;
  return sum_w;
}

void ThermalUnit::advance(Duration cycle) noexcept {
  Values heat_w{};
  for (std::size_t i = 0; i < count(); ++i) {
    const double t_c = network_.temperature_c(i);
    if (t_c < keeps_from_c_) zones_[i].own_on = true;
    if (t_c > keeps_to_c_) zones_[i].own_on = false;
    heat_w[i] = inside_w_[i] + (eclipse_ ? 0 : sunlit_w_[i]) + (heats(i) ? heater_w_[i] : 0);
  }
  network_.advance(faster_ * seconds(cycle), {heat_w.data(), count()});
}

Result<> ThermalUnit::take(OctetReader payload) noexcept {
  std::array<std::uint8_t, most_zones> on{}, line{};
  for (std::size_t i = 0; i < count(); ++i) on[i] = payload.get<std::uint8_t>();
  for (std::size_t i = 0; i < count(); ++i) line[i] = payload.get<std::uint8_t>();
  const auto own = payload.get<std::uint8_t>();
  if (!payload.exhausted()) return fail(ErrorCode::Malformed, "heater command size");
  for (std::size_t i = 0; i < count(); ++i) {
    zones_[i].on = on[i] != 0;
    zones_[i].line = line[i] != 0;
  }
  own_ = own != 0;
  return ok();
}

float ThermalUnit::reading_c(std::size_t zone) noexcept {
  const Zone& is = zones_[zone];
  // Drawn whatever is said in the end: a fault does not change what the others say.
  const double noise_k = random_.normal() * noise_k_;
  if (is.sensor == SensorFault::Dead) return dead_c;
  if (is.sensor == SensorFault::Stuck) return is.stuck_at_c;
  return static_cast<float>(network_.temperature_c(zone) + is.offset_k + noise_k);
}

void ThermalUnit::write_sensors(OctetWriter& payload) noexcept {
  for (std::size_t i = 0; i < count(); ++i) payload.put(reading_c(i));
  payload.put(static_cast<float>(drawn_w()));
}

Result<std::size_t> ThermalUnit::zone_of(const Words& words) const {
  HIROSCO_TRY_LET(const double zone, words.number(1, 0, static_cast<double>(count()) - 1));
  if (zone != std::floor(zone)) return fail(ErrorCode::InvalidArgument, "zones have whole numbers");
  return static_cast<std::size_t>(zone);
}

Result<> ThermalUnit::do_fault(const Words& words) {
  if (words[0] == "sensor" || words[0] == "sensor_offset" || words[0] == "heater" || words[0] == "temperature")
    return fault_of_zone(words);
  return set_world(words);
}

Result<> ThermalUnit::fault_of_zone(const Words& words) {
  HIROSCO_TRY(words.expect(3));
  HIROSCO_TRY_LET(const std::size_t i, zone_of(words));
  Zone& zone = zones_[i];
  if (words[0] == "temperature") {
    HIROSCO_TRY_LET(network_.node(i).temperature_c, words.number(2, coldest_c, hottest_c));
    return ok();
  }
  if (words[0] == "sensor_offset") {
    HIROSCO_TRY_LET(zone.offset_k, words.number(2, coldest_c, hottest_c));
    return ok();
  }
  const std::string_view what = words[2];
  if (words[0] == "sensor") {
    if (what == "well") zone.sensor = SensorFault::None;
    else if (what == "dead") zone.sensor = SensorFault::Dead;
    else if (what == "stuck") {
      zone.stuck_at_c = static_cast<float>(network_.temperature_c(i) + zone.offset_k);
      zone.sensor = SensorFault::Stuck;
    } else return fail(ErrorCode::InvalidArgument, "sensor ZONE dead, stuck or well");
    return ok();
  }
  if (what == "well") zone.heater = HeaterFault::None;
  else if (what == "stuck_on") zone.heater = HeaterFault::StuckOn;
  else if (what == "stuck_off") zone.heater = HeaterFault::StuckOff;
  else return fail(ErrorCode::InvalidArgument, "heater ZONE stuck_on, stuck_off or well");
  return ok();
}

Result<> ThermalUnit::set_world(const Words& words) {
  if (words[0] == "keeps") {
    HIROSCO_TRY(words.expect(3));
    HIROSCO_TRY_LET(const double from_c, words.number(1, coldest_c, hottest_c));
    HIROSCO_TRY_LET(keeps_to_c_, words.number(2, from_c, hottest_c));
    keeps_from_c_ = from_c;
    return ok();
  }
  HIROSCO_TRY(words.expect(2));
  if (words[0] == "eclipse") {
    if (words[1] != "on" && words[1] != "off") return fail(ErrorCode::InvalidArgument, "eclipse on or off");
    eclipse_ = words[1] == "on";
    return ok();
  }
  if (words[0] == "noise") {
    HIROSCO_TRY_LET(noise_k_, words.number(1, 0, 10));
    return ok();
  }
  if (words[0] == "temperatures") {
    HIROSCO_TRY_LET(const double t_c, words.number(1, coldest_c, hottest_c));
    for (std::size_t i = 0; i < count(); ++i) network_.node(i).temperature_c = t_c;
    return ok();
  }
  if (words[0] == "faster") {
    HIROSCO_TRY_LET(faster_, words.number(1, 0, 1000));
    return ok();
  }
  if (words[0] == "neighbours_w_k") {
    HIROSCO_TRY_LET(neighbours_w_k_, words.number(1, 0, 100));
    couple();
    return ok();
  }
  if (words[0] == "zones") {
    HIROSCO_TRY_LET(const double zones, words.number(1, 1, most_zones));
    if (zones != std::floor(zones)) return fail(ErrorCode::InvalidArgument, "a whole number of zones");
    std::array<ThermalNode, most_zones> nodes{};
    for (std::size_t i = 0; i < most_zones; ++i) nodes[i] = network_.node(i);
    network_.begin(std::span{nodes}.first(static_cast<std::size_t>(zones)));
    couple();
    return ok();
  }
  return set_each(words[0], words[1]);
}

/// One number for all zones, or as many as there are, with commas between them.
Result<> ThermalUnit::set_each(std::string_view name, std::string_view numbers) {
  struct Kind {
    std::string_view name;
    double least, most;
  };
  static constexpr std::array kinds{Kind{"heaters_w", 0, 1000}, Kind{"inside_w", 0, 1000}, Kind{"sunlit_w", 0, 1000},
                                    Kind{"capacities_j_k", 10, 1e7}, Kind{"radiating_m2", 0, 10}};
  const auto kind = std::ranges::find(kinds, name, &Kind::name);
  if (kind == kinds.end()) return fail(ErrorCode::InvalidArgument, "unknown fault");
  Values values{};
  std::size_t given = 0;
  bool good = true;
  for (bool more = true; more; ++given) {
    if (given == most_zones) return fail(ErrorCode::OutOfRange, "more numbers than zones");
    const std::size_t comma = numbers.find(',');
    values[given] = number_in(numbers.substr(0, comma), good);
    if (!good) return fail(ErrorCode::InvalidArgument, "not a number", static_cast<std::int64_t>(given));
    if (values[given] < kind->least || values[given] > kind->most)
      return fail(ErrorCode::OutOfRange, "number", static_cast<std::int64_t>(given));
    more = comma != std::string_view::npos;
    if (more) numbers.remove_prefix(comma + 1);
  }
  if (given == 1) values.fill(values[0]);
  else if (given != count())
    return fail(ErrorCode::InvalidArgument, "one number, or one for each zone", static_cast<std::int64_t>(count()));
  if (name == "heaters_w") heater_w_ = values;
  if (name == "inside_w") inside_w_ = values;
  if (name == "sunlit_w") sunlit_w_ = values;
  for (std::size_t i = 0; i < count(); ++i) {
    if (name == "capacities_j_k") network_.node(i).capacity_j_k = values[i];
    if (name == "radiating_m2") network_.node(i).radiating_m2 = values[i];
  }
  return ok();
}

std::string ThermalUnit::do_truth() const {
  std::string text = fmt::format("zones={} drawn_w={:.3f} eclipse={} own={}", count(), drawn_w(), eclipse_ ? 1 : 0,
                                 own_ || !active() ? 1 : 0);
  for (std::size_t i = 0; i < count(); ++i)
    text += fmt::format(" t{}={:.4f} heats{}={} line{}={}", i, network_.temperature_c(i), i, heats(i) ? 1 : 0, i,
                        zones_[i].line ? 1 : 0);
  return text;
}

/// What is broken is whole again; where the sun is and how warm it is is no fault.
void ThermalUnit::do_heal() noexcept {
  for (Zone& zone : zones_) {
    zone.sensor = SensorFault::None;
    zone.heater = HeaterFault::None;
    zone.offset_k = 0;
  }
}

}  // namespace hirosco::simulation
