// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/thermal/thermal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "subsystems/thermal/control/cut_out.hpp"
#include "subsystems/thermal/control/heat_law.hpp"
#include "subsystems/thermal/control/heater_share.hpp"
#include "subsystems/thermal/control/zone_sensor.hpp"

namespace hirosco {
namespace {

using thermal::CutOut;
using thermal::Doubt;
using thermal::HeatLaw;
using thermal::LawKind;
using thermal::most_zones;
using thermal::ZoneSensor;

using Floats = Sized<float, most_zones>;
using Switches = Sized<std::uint8_t, most_zones>;

/// Of a set point below what the cut-out takes for too hot: overshoot and noise fit between them.
constexpr float below_cut_out_k = 10;
constexpr float near_hottest_k = 3, beyond_survival_k = 1;
constexpr float reached_k = 0.5F, reached_for_s = 10;
constexpr float short_for_s = 60;

class Thermal final : public Subsystem {
  // Structures of thermal.xml: same members, same order.
  struct HeaterValues {
    Floats share;
    Switches on;
    Switches line;
  };
  struct PowerValues {
    float commanded_w;
    float drawn_w;
    float most_w;
  };
  struct ZoneValues {
    Floats heater_w;
    Floats survival_c;
    Floats hottest_c;
    Floats safe_share;
    Switches rank;
  };
  struct Law {
    LawKind kind;
    float gain_per_k;
    float reset_s;
    float hysteresis_k;
  };
  struct Unit {
    Floats t_c;
    float drawn_w;
  };
  struct Commands {
    Switches on;
    Switches line;
    std::uint8_t own;
  };
  enum class Trouble : std::uint16_t {
    too_hot = 0x8001,
    too_cold = 0x8002,
    still_hot = 0x8003,
    no_temperature = 0x8004,
    no_such_zone = 0x8005,
  };
  struct Zone {
    ZoneSensor sensor;
    CutOut cut_out;
    HeatLaw law;
    float near_s{0};  ///< that it has been within reach of its set point
    float short_s{0};
    bool reached_told{false};
    bool short_told{false};
    bool out_told{false};
  };

  Result<Step> software_init() override {
    publish("T", t_c_);
    publish("HEATERS", heaters_);
    publish("SET_POINTS", set_points_c_);
    publish("SENSORS", sensors_);
    publish("POWER", power_);
    publish("ZONES", zone_values_);
    publish("LAW", law_);
    publish("SENSOR_LIMITS", limits_);
    use_device("UNIT", unit_);
    use_event(temperature_out_);
    use_event(over_temperature_);
    use_event(sensor_doubted_);
    use_event(power_short_);
    use_event(heaters_differ_);
    use_event(set_point_reached_);
    on_function("SET_POINT", [this](std::uint8_t zone, float t_c) -> Outcome { return set_point(zone, t_c); });
    on_function("CLOSE_LINE", [this](std::uint8_t zone) -> Outcome {
      if (zone >= count_) return refused(Trouble::no_such_zone, "zones there are", static_cast<std::int64_t>(count_));
      const bool closed = zones_[zone].cut_out.close(t_c_.load()[zone], hottest_c(zone), limits());
      return closed ? Outcome{ok()} : refused(Trouble::still_hot, "degC it has to be colder than", cooled_c(zone));
    });
    on_function("TRUST_SENSOR", [this](std::uint8_t zone) -> Outcome {
      if (zone >= count_) return refused(Trouble::no_such_zone, "zones there are", static_cast<std::int64_t>(count_));
      if (!unit_.alive() || !zones_[zone].sensor.trust(t_c_.load()[zone], limits()))
        return refused(Trouble::no_temperature, "what it says is none", zone);
      return ok();
    });
    return lengths_agree();
  }

  Result<> configure(const descriptor::Configuration& configuration) override {
    dt_s_ = static_cast<float>(seconds(configuration.sampling));
    begin_anew();
    return ok();
  }
  /// Either law goes on from the share that the other one gave.
  Result<> bumpless(const descriptor::Configuration&, const descriptor::Configuration&,
                    const Cycle&) noexcept override {
    return ok();
  }

  Result<> pre_operational(const Cycle&) noexcept override { return unit_keeps(); }
  Result<> error_operational(const Cycle&) noexcept override { return unit_keeps(); }
  Result<> safe_operational(const Cycle&) noexcept override {
    measure();
    return heat(LawKind::Thermostat);
  }
  Result<> operational(const Cycle&) noexcept override {
    measure();
    return heat(law_.load().kind);
  }

  /// All that is per zone is of as many zones, or something else would be heated than is measured.
  Result<Step> lengths_agree() {
    count_ = t_c_.load().size();
    const auto zones = zone_values_.load();
    const auto heaters = heaters_.load();
    std::vector<std::size_t> lengths{
        heaters.share.size(),    heaters.on.size(),     heaters.line.size(),     set_points_c_.load().size(),
        sensors_.load().size(),  zones.heater_w.size(), zones.survival_c.size(), zones.hottest_c.size(),
        zones.safe_share.size(), zones.rank.size()};
    // What is exchanged with the unit has its lengths from its configuration only.
    for (const descriptor::Device& device : own_descriptor().devices) {
      lengths.push_back(device.input.front().count);
      for (const auto& output : device.output)
        if (output.field.name != "OWN") lengths.push_back(output.field.count);
    }
    for (const std::size_t length : lengths)
      if (length != count_)
        return fail(ErrorCode::InvalidArgument, "T and all that is for each zone have as many elements",
                    static_cast<std::int64_t>(length));
    for (Zone& zone : zones_) zone = {};
    return done;
  }

  Outcome set_point(std::uint8_t zone, float t_c) noexcept {
    if (zone >= count_) return refused(Trouble::no_such_zone, "zones there are", static_cast<std::int64_t>(count_));
    const float most_c = hottest_c(zone) - below_cut_out_k;
    if (t_c > most_c) return refused(Trouble::too_hot, "degC at most, 10 K below the cut-out", std::llround(most_c));
    const float least_c = zone_values_.load().survival_c[zone];
    if (t_c < least_c) return refused(Trouble::too_cold, "degC at least, to survive", std::llround(least_c));
    Floats all = set_points_c_.load();
    all[zone] = t_c;
    set_points_c_.store(all);
    zones_[zone].reached_told = false;
    zones_[zone].near_s = 0;
    return ok();
  }

  /// Not the cut-outs: what was too hot stays without a line until somebody says otherwise.
  void begin_anew() noexcept {
    for (Zone& zone : zones_) {
      const CutOut cut_out = zone.cut_out;
      zone = {};
      zone.cut_out = cut_out;
    }
    share_.begin();
    drawn_ = {};
    commanded_w_ = 0;
    watched_ = false;
    unheard_s_ = 0;
  }

  Result<> unit_keeps() noexcept {
    measure();
    watched_ = false;
    put_out(Floats::zeros(count_), Switches::zeros(count_), true);
    return ok();
  }

  void measure() noexcept {
    unheard_s_ += dt_s_;
    if (!unit_.fresh()) return;
    const float dt_s = std::exchange(unheard_s_, 0.0F);
    const Unit& in = unit_.input();
    const thermal::SensorLimits by = limits();
    Switches states = Switches::zeros(count_);
    for (std::size_t i = 0; i < count_; ++i) {
      Zone& zone = zones_[i];
      const auto number = static_cast<std::uint8_t>(i);
      if (const Doubt why = zone.sensor.update(in.t_c[i], dt_s, by); why != Doubt::None)
        raise(sensor_doubted_, number, why, in.t_c[i]);
      if (zone.cut_out.update(in.t_c[i], hottest_c(i), by)) raise(over_temperature_, number, in.t_c[i]);
      states[i] = static_cast<std::uint8_t>(zone.sensor.doubt());
      tell_if_out(zone, number);
    }
    t_c_.store(in.t_c);
    sensors_.store(states);
    PowerValues power = power_.load();
    power.drawn_w = in.drawn_w;
    power_.store(power);
    // What the unit keeps by itself nobody has commanded.
    if (watched_ && drawn_.update(commanded_w_, in.drawn_w)) raise(heaters_differ_, commanded_w_, in.drawn_w);
  }

  void tell_if_out(Zone& zone, std::uint8_t number) noexcept {
    if (!zone.sensor.good()) return;
    const float t_c = zone.sensor.temperature_c();
    const float coldest_c = zone_values_.load().survival_c[number] - law_.load().hysteresis_k / 2;
    const float back_k = zone.out_told ? beyond_survival_k : 0;
    const bool out = t_c < coldest_c - beyond_survival_k + back_k || t_c > hottest_c(number) - near_hottest_k - back_k;
    if (out && !zone.out_told) raise(temperature_out_, number, t_c);
    zone.out_told = out;
  }

  Result<> heat(LawKind kind) noexcept {
    const ZoneValues is = zone_values_.load();
    std::array<thermal::Wanted, most_zones> wanted{};
    Floats shares = Floats::zeros(count_);
    for (std::size_t i = 0; i < count_; ++i) {
      Zone& zone = zones_[i];
      shares[i] = share_of(zone, i, kind, is);
      wanted[i] = {.share = shares[i],
                   .heater_w = is.heater_w[i],
                   .rank = is.rank[i],
                   .urgent = zone.sensor.good() && zone.sensor.temperature_c() < is.survival_c[i]};
      tell_if_reached(zone, static_cast<std::uint8_t>(i), kind);
    }
    // What a switch that does not open draws is not there for the others.
    const float most_w = power_.load().most_w;
    Switches on = Switches::zeros(count_);
    share_.share({wanted.data(), count_}, most_w - drawn_.excess_w(), on);
    for (std::size_t i = 0; i < count_; ++i) tell_if_short(zones_[i], static_cast<std::uint8_t>(i), most_w);
    put_out(shares, on, false);
    commanded_w_ = share_.drawn_w();
    watched_ = true;
    return ok();
  }

  [[nodiscard]] float share_of(Zone& zone, std::size_t i, LawKind kind, const ZoneValues& is) noexcept {
    if (zone.cut_out.open()) {
      zone.law.begin(0);
      return 0;
    }
    if (!zone.sensor.good()) {
      zone.law.begin(is.safe_share[i]);
      return is.safe_share[i];
    }
    const Law law = law_.load();
    const thermal::LawValues values{law.gain_per_k, law.reset_s, law.hysteresis_k};
    const float t_c = zone.sensor.temperature_c();
    if (kind == LawKind::Thermostat) return zone.law.thermostat(is.survival_c[i] - t_c, values);
    const auto given = share_.is_short(i) ? HeatLaw::Given::Less : HeatLaw::Given::All;
    return zone.law.proportional(set_points_c_.load()[i] - t_c, dt_s_, given, values);
  }

  void tell_if_reached(Zone& zone, std::uint8_t number, LawKind kind) noexcept {
    const float t_c = zone.sensor.temperature_c();
    const bool near =
        kind == LawKind::Proportional && zone.sensor.good() && std::abs(t_c - set_points_c_.load()[number]) < reached_k;
    zone.near_s = near ? zone.near_s + dt_s_ : 0;
    if (zone.near_s < reached_for_s || zone.reached_told) return;
    zone.reached_told = true;
    raise(set_point_reached_, number, t_c);
  }

  void tell_if_short(Zone& zone, std::uint8_t number, float most_w) noexcept {
    zone.short_s = share_.is_short(number) ? zone.short_s + dt_s_ : 0;
    if (zone.short_s >= short_for_s && !zone.short_told) raise(power_short_, number, most_w);
    zone.short_told = zone.short_s >= short_for_s;
  }

  void put_out(const Floats& shares, const Switches& on, bool unit_keeps) noexcept {
    Switches line = Switches::zeros(count_);
    for (std::size_t i = 0; i < count_; ++i) line[i] = zones_[i].cut_out.open() ? 0 : 1;
    heaters_.store({shares, on, line});
    unit_.output() = {on, line, static_cast<std::uint8_t>(unit_keeps ? 1 : 0)};
    PowerValues power = power_.load();
    power.commanded_w = unit_keeps ? 0 : share_.drawn_w();
    power_.store(power);
  }

  [[nodiscard]] thermal::SensorLimits limits() const noexcept { return limits_.load(); }
  [[nodiscard]] float hottest_c(std::size_t zone) const noexcept { return zone_values_.load().hottest_c[zone]; }
  [[nodiscard]] std::int64_t cooled_c(std::size_t zone) const noexcept {
    return std::llround(hottest_c(zone) - CutOut::cooled_k);
  }

  Parameter<Floats> t_c_, set_points_c_;
  Parameter<HeaterValues> heaters_;
  Parameter<Switches> sensors_;
  Parameter<PowerValues> power_;
  Parameter<ZoneValues> zone_values_;
  Parameter<Law> law_;
  Parameter<thermal::SensorLimits> limits_;
  Event<std::uint8_t, float> temperature_out_{"TEMPERATURE_OUT"},
      over_temperature_{"OVER_TEMPERATURE"};  ///< zone, degC
  Event<std::uint8_t, Doubt, float> sensor_doubted_{"SENSOR_DOUBTED"};
  Event<std::uint8_t, float> power_short_{"POWER_SHORT"};  ///< zone, W
  Event<float, float> heaters_differ_{"HEATERS_DIFFER"};  ///< W, W
  Event<std::uint8_t, float> set_point_reached_{"SET_POINT_REACHED"};  ///< zone, degC
  DevicePort<Unit, Commands> unit_;

  std::array<Zone, most_zones> zones_{};
  thermal::HeaterShare share_;
  thermal::DrawnWatch drawn_;
  std::size_t count_{0};
  float dt_s_{0.1F};
  float unheard_s_{0};  ///< since the unit's last frame
  float commanded_w_{0};  ///< in the last cycle: what the unit answers now
  bool watched_{false};  ///< and the heaters were ours in it
};

}  // namespace

std::unique_ptr<Subsystem> make_thermal() { return std::make_unique<Thermal>(); }

}  // namespace hirosco
