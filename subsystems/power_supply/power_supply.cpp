// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/power_supply/power_supply.hpp"

#include <array>
#include <limits>

#include "subsystems/power_supply/power_rule.hpp"

namespace hirosco {
namespace {

/// Loads have to fall below this share of what there is before it is told again that they exceed it.
constexpr double again_below = 0.95;

class PowerSupply final : public Subsystem {
  // Structures of power_supply.xml: same members, same order.
  struct Loads {
    double platform_w;
    double payload_w;
    double sum_w;
  };
  struct RuleValues {
    double array_w;
    double battery_w;
    double least_soc;
    double critical_soc;
  };
  struct Unit {
    double array_w;
    double sun_angle_deg;
    double charge;
    double bus_v;
    std::array<double, 2> current_a;
    std::uint8_t eclipse;
  };
  struct Outlets {
    std::uint8_t payload_on;
  };

  Result<Step> software_init() override {
    publish("ARRAY_W", array_w_);
    publish("BATT_SOC", charge_);
    publish("LOADS", loads_);
    publish("BUDGET_W", budget_w_);
    publish("SUN_ANGLE", sun_angle_deg_);
    publish("ECLIPSE", eclipse_);
    publish("BUS", bus_v_);
    publish("RULE", rule_);
    publish("PAYLOAD_ON", payload_on_);
    use_device("UNIT", unit_);
    use_event(bus_low_);
    use_event(load_shed_);
    use_event(eclipse_begins_);
    use_event(eclipse_ends_);
    budget_w_.store(unknown);
    return done;
  }
  Result<> configure(const descriptor::Configuration&) override {
    budget_w_.store(unknown);
    return ok();
  }
  Result<> bumpless(const descriptor::Configuration&, const descriptor::Configuration&,
                    const Cycle&) noexcept override {
    return ok();
  }

  // It measures and tells in every state: what there is does not depend on ours.
  Result<> pre_operational(const Cycle&) noexcept override { return measure(); }
  Result<> safe_operational(const Cycle&) noexcept override { return measure(); }
  Result<> operational(const Cycle&) noexcept override { return measure(); }
  Result<> error_operational(const Cycle&) noexcept override { return measure(); }

  Result<> measure() noexcept {
    unit_.output().payload_on = payload_on_.load();
    if (!unit_.alive()) {
      budget_w_.store(unknown);
      return ok();
    }
    const Unit in = unit_.input();
    const RuleValues rule = rule_.load();
    const power_supply::Measured measured{in.array_w, in.sun_angle_deg, in.eclipse != 0, in.charge};
    const power_supply::Rule by{rule.array_w, rule.battery_w, rule.least_soc};
    const Loads loads{in.bus_v * in.current_a[0], in.bus_v * in.current_a[1],
                      in.bus_v * (in.current_a[0] + in.current_a[1])};
    const double budget_w = power_supply::available_w(by, measured);
    array_w_.store(in.array_w);
    charge_.store(in.charge);
    loads_.store(loads);
    sun_angle_deg_.store(in.sun_angle_deg);
    bus_v_.store(in.bus_v);
    budget_w_.store(budget_w);
    tell_eclipse(measured.eclipse);
    tell_shortage(loads.sum_w, budget_w);
    const bool discharging = loads.sum_w > power_supply::from_array_w(by, measured);
    tell_critical(discharging && in.charge < rule.critical_soc, loads.sum_w, in.charge);
    return ok();
  }

  void tell_eclipse(bool now) noexcept {
    const bool was = eclipse_.load() != 0;
    eclipse_.store(now ? 1 : 0);
    if (now && !was) raise(eclipse_begins_);
    if (!now && was) raise(eclipse_ends_);
  }
  void tell_shortage(double loads_w, double budget_w) noexcept {
    if (loads_w > budget_w && !short_) raise(bus_low_, loads_w, budget_w);
    short_ = loads_w > (short_ ? again_below : 1) * budget_w;
  }
  void tell_critical(bool now, double loads_w, double charge) noexcept {
    if (now && !critical_) raise(load_shed_, loads_w, charge);
    critical_ = now;
  }

  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  Parameter<double> array_w_, charge_, budget_w_, sun_angle_deg_, bus_v_;
  Parameter<Loads> loads_;
  Parameter<RuleValues> rule_;
  Parameter<std::uint8_t> eclipse_, payload_on_;
  Event<double, double> bus_low_{"BUS_LOW"};  ///< W, W
  Event<double, double> load_shed_{"LOAD_SHED"};  ///< W, share
  Event<> eclipse_begins_{"ECLIPSE_BEGINS"}, eclipse_ends_{"ECLIPSE_ENDS"};
  DevicePort<Unit, Outlets> unit_;
  bool short_{false};
  bool critical_{false};
};

}  // namespace

std::unique_ptr<Subsystem> make_power_supply() { return std::make_unique<PowerSupply>(); }

}  // namespace hirosco
