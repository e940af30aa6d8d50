// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "missions/rokviss/independent/coupled_loop.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace hirosco::independent {
namespace {

// Numbers of the note, by its own letters.
constexpr double l1 = 0.25, l2 = 0.22, m1 = 3.0, m2 = 1.6, c1 = 0.17, c2 = 0.10, i1 = 0.020, i2 = 0.008;
constexpr double b = 1.28, k = 4000, d = 4, viscous = 2, coulomb = 1, smooth_rad_s = 0.01, most_n_m = 60;
constexpr double rail_m = 0.350, finger_m = 0.010, rail_k = 5e4, rail_c = 2, rub = 0.15, rub_m_s = 1e-3;
constexpr double handle_j = 0.003 + 0.0072, handle_d = 0.01, hand_k = 4.3, hand_d = 0.144, display_n_m = 1.5;
constexpr double end_rad = 0.40, end_k = 60, end_d = 0.3;
constexpr double kp = 300, kd = 24, rate_share = 0.2;
constexpr Pair home{-0.80, 1.60};
constexpr double tick_s = 0.0005;

template <std::size_t N>
using State = std::array<double, N>;

/// Dormand and Prince 5(4): from `x` over `span`, `rates(t, x)`.
template <std::size_t N, class Rates>
State<N> integrated(State<N> x, double span, double tolerance, const Rates& rates) {
  static constexpr double a[7][6] = {{},
                                     {1.0 / 5},
                                     {3.0 / 40, 9.0 / 40},
                                     {44.0 / 45, -56.0 / 15, 32.0 / 9},
                                     {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
                                     {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
                                     {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
  static constexpr double c[7] = {0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1, 1};
  static constexpr double fourth[7] = {5179.0 / 57600, 0,       7571.0 / 16695, 393.0 / 640, -92097.0 / 339200,
                                       187.0 / 2100,   1.0 / 40};
  constexpr double smallest_s = 1e-9;
  double at = 0, h = span / 2;
  while (at < span) {
    h = std::min(h, span - at);
    std::array<State<N>, 7> slope;
    State<N> fifth = x;
    for (std::size_t stage = 0; stage < 7; ++stage) {
      State<N> y = x;
      for (std::size_t before = 0; before < stage; ++before)
        for (std::size_t n = 0; n < N; ++n) y[n] += h * a[stage][before] * slope[before][n];
      slope[stage] = rates(at + c[stage] * h, y);
      if (stage == 6) fifth = y;
    }
    double worst = 0;
    for (std::size_t n = 0; n < N; ++n) {
      double lower = x[n];
      for (std::size_t stage = 0; stage < 7; ++stage) lower += h * fourth[stage] * slope[stage][n];
      worst = std::max(worst, std::abs(fifth[n] - lower) / (tolerance * (1 + std::abs(fifth[n]))));
    }
    if (worst <= 1 || h <= smallest_s) {
      at += h;
      x = fifth;
    }
    h = std::max(smallest_s, h * std::clamp(0.9 * std::pow(std::max(worst, 1e-10), -0.2), 0.2, 4.0));
  }
  return x;
}

struct Rail {
  double depth, normal_n, along_n;
};

/// x and y of the tip and their rates, by the absolute angles of the links.
Rail rail_at(double x, double x_rate, double y_rate, double friction) {
  const double depth = x + finger_m - rail_m;
  if (depth <= 0) return {depth, 0, 0};
  const double normal = std::max(0.0, rail_k * depth * (1 + rail_c * x_rate));
  return {depth, normal, -friction * rub * normal * std::tanh(y_rate / rub_m_s)};
}

/// Motor angles, their rates; absolute link angles, their rates.
class Arm {
 public:
  explicit Arm(Friction friction, const Spring* spring)
      : friction_{friction == Friction::On ? 1.0 : 0.0}, spring_{spring} {
    x_ = {home[0], home[1], 0, 0, home[0], home[0] + home[1], 0, 0};
  }
  void hook() noexcept { hooked_ = spring_ != nullptr; }
  void move(const Pair& motor_n_m) {
    x_ = integrated<8>(x_, tick_s, 1e-10, [&](double, const State<8>& x) { return rates(x, motor_n_m); });
  }
  [[nodiscard]] Pair motor_rad() const { return {x_[0], x_[1]}; }
  [[nodiscard]] Pair motor_rate() const { return {x_[2], x_[3]}; }
  [[nodiscard]] Pair link_rad() const { return {x_[4], x_[5] - x_[4]}; }
  [[nodiscard]] Pair torque() const { return torque_of(x_); }
  [[nodiscard]] Rail rail() const { return rail_of(x_); }
  [[nodiscard]] double spring_n() const {
    const Pair force = spring_of(x_);
    return std::hypot(force[0], force[1]);
  }

 private:
  static Pair torque_of(const State<8>& x) {
    return {k * (x[0] - x[4]) + d * (x[2] - x[6]), k * (x[1] - (x[5] - x[4])) + d * (x[3] - (x[7] - x[6]))};
  }
  [[nodiscard]] Rail rail_of(const State<8>& x) const {
    return rail_at(l1 * std::cos(x[4]) + l2 * std::cos(x[5]), -l1 * std::sin(x[4]) * x[6] - l2 * std::sin(x[5]) * x[7],
                   l1 * std::cos(x[4]) * x[6] + l2 * std::cos(x[5]) * x[7], friction_);
  }
  [[nodiscard]] Pair spring_of(const State<8>& x) const {
    if (!hooked_) return {};
    const double away_x = l1 * std::cos(x[4]) + l2 * std::cos(x[5]) - spring_->anchor_m[0];
    const double away_y = l1 * std::sin(x[4]) + l2 * std::sin(x[5]) - spring_->anchor_m[1];
    const double length = std::hypot(away_x, away_y), pull = spring_->n_per_m * (length - spring_->free_m);
    return pull <= 0 ? Pair{} : Pair{-pull * away_x / length, -pull * away_y / length};
  }
  [[nodiscard]] State<8> rates(const State<8>& x, const Pair& motor_n_m) const {
    const Pair joint = torque_of(x);
    const Rail rail = rail_of(x);
    const double one = x[4], two = x[5], u = x[6], v = x[7];
    // A a1'' + C cos(a1 - a2) a2'' = Q1 - C sin(a1 - a2) a2'^2, and with the roles changed for a2.
    const double A = i1 + m1 * c1 * c1 + m2 * l1 * l1, B = i2 + m2 * c2 * c2, C = m2 * l1 * c2;
    const double mixed = C * std::cos(one - two), turn = C * std::sin(one - two);
    const Pair spring = spring_of(x);
    const double push_x = spring[0] - rail.normal_n, push_y = spring[1] + rail.along_n;
    const double q1 = joint[0] - joint[1] - push_x * l1 * std::sin(one) + push_y * l1 * std::cos(one);
    const double q2 = joint[1] - push_x * l2 * std::sin(two) + push_y * l2 * std::cos(two);
    const double r1 = q1 - turn * v * v, r2 = q2 + turn * u * u, det = A * B - mixed * mixed;
    State<8> rate{x[2], x[3], 0, 0, u, v, (B * r1 - mixed * r2) / det, (A * r2 - mixed * r1) / det};
    for (std::size_t i = 0; i < 2; ++i) {
      const double loss = viscous * x[2 + i] + coulomb * std::tanh(x[2 + i] / smooth_rad_s);
      rate[2 + i] = (motor_n_m[i] - joint[i] - friction_ * loss) / b;
    }
    return rate;
  }

  double friction_;
  const Spring* spring_;
  bool hooked_{false};
  State<8> x_{};
};

/// What the hand wants the handle to do, and the handle with the hand on it.
class Handle {
 public:
  explicit Handle(const Conditions& conditions) : conditions_{conditions}, legs_{conditions.legs} {
    if (legs_.empty()) legs_.push_back({0, conditions.offset_m, conditions.hand_span_s});
    // J^-1 of home
    const double one = home[0], two = home[0] + home[1];
    const double a = -l1 * std::sin(one) - l2 * std::sin(two), p = -l2 * std::sin(two);
    const double c = l1 * std::cos(one) + l2 * std::cos(two), q = l2 * std::cos(two);
    const double det = a * q - p * c;
    for (const Leg& leg : legs_)
      goals_.push_back(
          {(q * leg.offset_m[0] - p * leg.offset_m[1]) / det, (-c * leg.offset_m[0] + a * leg.offset_m[1]) / det});
  }
  void move(const Pair& display) {
    const double start = time_;
    x_ = integrated<4>(x_, tick_s, 1e-10, [&](double past, const State<4>& x) {
      State<4> rate{x[2], x[3], 0, 0};
      for (std::size_t i = 0; i < 2; ++i) {
        const auto [wish, pace] = wish_at(start + past, i);
        const double motor = std::clamp(display[i], -display_n_m, display_n_m);
        const double beyond = x[i] - std::clamp(x[i], -end_rad, end_rad);
        const double stop = beyond != 0 ? end_k * beyond + end_d * x[2 + i] : 0;
        rate[2 + i] =
            (motor - handle_d * x[2 + i] + hand_k * (wish - x[i]) + hand_d * (pace - x[2 + i]) - stop) / handle_j;
      }
      return rate;
    });
    time_ += tick_s;
  }
  [[nodiscard]] Pair angle() const { return {x_[0], x_[1]}; }
  [[nodiscard]] Pair rate() const { return {x_[2], x_[3]}; }

 private:
  [[nodiscard]] Pair wish_at(double time, std::size_t axis) const {
    if (conditions_.hand == Hand::Sine) {
      const double w = 2 * std::numbers::pi * conditions_.sine_hz, a = conditions_.sine_rad[axis];
      return {a * std::sin(w * time), a * w * std::cos(w * time)};
    }
    std::size_t leg = 0;
    while (leg + 1 < legs_.size() && time >= legs_[leg + 1].begin_s) ++leg;
    const double from = leg == 0 ? 0 : goals_[leg - 1][axis], way = goals_[leg][axis] - from;
    const double span = legs_[leg].span_s, s = (time - legs_[leg].begin_s) / span;
    if (s >= 1) return {from + way, 0};
    if (s <= 0) return {from, 0};
    if (conditions_.hand == Hand::Ramp) return {from + s * way, way / span};
    return {from + way * (10 * std::pow(s, 3) - 15 * std::pow(s, 4) + 6 * std::pow(s, 5)),
            way / span * 30 * s * s * (1 - 2 * s + s * s)};
  }

  const Conditions& conditions_;
  std::vector<Leg> legs_;
  std::vector<Pair> goals_;
  State<4> x_{};
  double time_{0};
};

/// The robot's controller.
class Controller {
 public:
  Pair torque(const Pair& desired, const Arm& arm) {
    const Pair angle = arm.motor_rad(), rate = arm.motor_rate(), joint = arm.torque();
    Pair motor{};
    for (std::size_t i = 0; i < 2; ++i) {
      velocity_[i] = (1 - rate_share) * velocity_[i] + rate_share * (desired[i] - before_[i]) / tick_s;
      const double u = kp * (desired[i] - angle[i]) + kd * (velocity_[i] - rate[i]);
      motor[i] = std::clamp(4 * u - 3 * joint[i], -most_n_m, most_n_m);
    }
    before_ = desired;
    return motor;
  }

 private:
  Pair before_ = home, velocity_{};
};

/// The stop that the joints do by themselves (adr 0025), until their brakes grip: damped and giving way, then holding.
class Stop {
 public:
  Pair torque(const Arm& arm) {
    const Pair angle = arm.motor_rad(), rate = arm.motor_rate(), joint = arm.torque();
    if (++ticks_ == half_ticks) held_ = {angle[0] + joint[0] / hold_k, angle[1] + joint[1] / hold_k};
    Pair motor{};
    for (std::size_t i = 0; i < 2; ++i) {
      const double u = -kd * rate[i] + (ticks_ < half_ticks ? 0 : hold_k * (held_[i] - angle[i]));
      motor[i] = std::clamp(4 * u - 3 * joint[i], -most_n_m, most_n_m);
    }
    return motor;
  }

 private:
  static constexpr int half_ticks = 200;
  static constexpr double hold_k = 600;
  int ticks_{0};
  Pair held_{};
};

/// Position and force, and the passivity observer and controller.
class Display {
 public:
  Display(const Conditions& conditions)
      : conditions_{conditions}, period_{conditions.ticks_per_handle_cycle * tick_s} {}
  Pair torque(const Pair& robot, const Pair& rate) {
    Pair shown{};
    for (std::size_t i = 0; i < 2; ++i) {
      double torque = -conditions_.force_scale * robot[i];
      energy_[i] -= torque * rate[i] * period_;
      if (conditions_.passivity == Passivity::On && energy_[i] < 0 && std::abs(rate[i]) >= 1e-3) {
        const double damping = std::min(1.0, -energy_[i] / (rate[i] * rate[i] * period_));
        torque -= damping * rate[i];
        energy_[i] += damping * rate[i] * rate[i] * period_;
      }
      shown[i] = std::clamp(torque, -display_n_m, display_n_m);
    }
    return shown;
  }

 private:
  const Conditions& conditions_;
  double period_;
  Pair energy_{};
};

/// Gives what was put in `ticks` ago.
class Delay {
 public:
  Delay(int ticks) : held_(static_cast<std::size_t>(std::max(ticks, 0)) + 1) {}
  void put(std::size_t tick, const Pair& value) { held_[tick % held_.size()] = value; }
  [[nodiscard]] Pair get(std::size_t tick) const { return held_[(tick + 1) % held_.size()]; }

 private:
  std::vector<Pair> held_;
};

}  // namespace

std::vector<Sample> fly(const Conditions& conditions) {
  Arm arm{conditions.friction, conditions.spring ? &*conditions.spring : nullptr};
  Handle handle{conditions};
  Controller controller;
  Stop stop;
  Display display{conditions};
  Delay up{conditions.up_ticks}, down{conditions.down_ticks};
  Pair sent{}, followed{}, shown{};
  int beyond = 0;
  bool off = false;
  std::vector<Sample> flight;
  const auto ticks = static_cast<std::size_t>(std::lround(conditions.span_s / tick_s));
  const auto cycle = static_cast<std::size_t>(conditions.ticks_per_handle_cycle);
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    down.put(tick, off ? Pair{} : arm.torque());
    if (tick % cycle == static_cast<std::size_t>(conditions.handle_phase_ticks) % cycle) {
      shown = display.torque(down.get(tick), handle.rate());
      sent = handle.angle();
      for (std::size_t i = 0; i < 2; ++i) followed[i] += conditions.filter * (sent[i] - followed[i]);
    }
    up.put(tick, followed);
    const Pair angles = up.get(tick);
    const Pair asked{home[0] + angles[0], home[1] + angles[1]}, met = arm.link_rad();
    Pair motor = controller.torque(asked, arm);
    const Pair measured = arm.torque();
    const bool above = conditions.torque_limit_n_m > 0 &&
                       std::max(std::abs(measured[0]), std::abs(measured[1])) > conditions.torque_limit_n_m;
    beyond = (beyond << 1 | (above ? 1 : 0)) & 7;
    off = off || beyond == 3 || beyond == 5 || beyond == 6 || beyond == 7;
    if (off) motor = stop.torque(arm);
    if (conditions.spring && static_cast<double>(tick) * tick_s >= conditions.hooked_s) arm.hook();
    arm.move(motor);
    handle.move(shown);
    const Rail rail = arm.rail();
    flight.push_back({static_cast<double>(tick + 1) * tick_s, rail.normal_n, rail.depth, arm.spring_n(), arm.torque(),
                      motor, arm.motor_rad(), arm.link_rad(), handle.angle(), shown, off, asked, met});
  }
  return flight;
}

double resting_force_n(double ordinate_m, double depth_m, double gain_n_m_per_rad) {
  // Inverse kinematics of the tip that is wanted, elbow as at home.
  const double x = rail_m - finger_m + depth_m, square = x * x + ordinate_m * ordinate_m;
  const double elbow = std::acos((square - l1 * l1 - l2 * l2) / (2 * l1 * l2));
  const double shoulder = std::atan2(ordinate_m, x) - std::atan2(l2 * std::sin(elbow), l1 + l2 * std::cos(elbow));
  // Controller and flexible joint one behind the other: tau = gain (qd - theta) = k (theta - q), and tau = -J^T (F, 0).
  const double series = 1 / (1 / gain_n_m_per_rad + 1 / k);
  double force = 0;
  for (int i = 0; i < 100; ++i) {
    Pair q{shoulder, elbow};
    for (int j = 0; j < 100; ++j) {
      const double one = q[0], two = q[0] + q[1];
      q = {shoulder + force * (l1 * std::sin(one) + l2 * std::sin(two)) / series,
           elbow + force * l2 * std::sin(two) / series};
    }
    const double depth = l1 * std::cos(q[0]) + l2 * std::cos(q[0] + q[1]) + finger_m - rail_m;
    // A rail so much stiffer than the joints is come near to by small shares of what it would push.
    force += 0.05 * (rail_k * depth - force);
  }
  return force;
}

Figures figures_of(const std::vector<Sample>& flight) {
  Figures figures;
  double judged = 0, lost = 0, summed = 0;
  for (const Sample& sample : flight) {
    for (const double torque : sample.torque_n_m) figures.peak_n_m = std::max(figures.peak_n_m, std::abs(torque));
    if (sample.time_s > 4) ++judged;
    if (sample.time_s > 4 && sample.force_n <= 0) ++lost;
    if (sample.time_s <= 7) continue;
    ++summed;
    figures.end_force_n += sample.force_n;
  }
  figures.lost_share = judged > 0 ? lost / judged : 0;
  figures.end_force_n = summed > 0 ? figures.end_force_n / summed : 0;
  return figures;
}

}  // namespace hirosco::independent
