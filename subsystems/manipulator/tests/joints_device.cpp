// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "simulation/devices/module.hpp"
#include "simulation/world/numerics.hpp"

/// Any number of flexible joints, for tests of hirosco-arm, and to copy from.
namespace {

using namespace hirosco;
using namespace hirosco::simulation;

/// A motor with friction, a gear that gives way, and a link behind it, in zero gravity; the links do not feel each other.
struct Joint {
  std::array<double, 4> x{};  ///< motor rad, rad/s, link rad, rad/s
  double link_inertia_kg_m2{0.1};
  double push_n_m{0};  ///< at the link, by somebody

  [[nodiscard]] double motor_rad() const noexcept { return x[0]; }
  [[nodiscard]] double motor_rad_s() const noexcept { return x[1]; }
  [[nodiscard]] double link_rad() const noexcept { return x[2]; }
  [[nodiscard]] double link_rad_s() const noexcept { return x[3]; }
  [[nodiscard]] static double torque_n_m(const std::array<double, 4>& at) noexcept {
    constexpr double stiffness_n_m_per_rad = 4000, damping_n_m_s_per_rad = 20;
    return stiffness_n_m_per_rad * (at[0] - at[2]) + damping_n_m_s_per_rad * (at[1] - at[3]);
  }
  void step(double motor_n_m, double span_s) noexcept {
    constexpr double motor_inertia_kg_m2 = 1.28, viscous_n_m_s = 2, dry_n_m = 1, dry_from_rad_s = 0.01;
    constexpr int sub_steps = 4;
    for (int i = 0; i < sub_steps; ++i)
      x = runge_kutta_4(x, span_s / sub_steps, [&](const std::array<double, 4>& at) {
        const double friction = viscous_n_m_s * at[1] + dry_n_m * std::tanh(at[1] / dry_from_rad_s);
        const double between = torque_n_m(at);
        return std::array{at[1], (motor_n_m - between - friction) / motor_inertia_kg_m2, at[3],
                          (between + push_n_m) / link_inertia_kg_m2};
      });
  }
};

/// Holds the motor where it was when it gripped: it gives way a little, and slips beyond its torque.
struct Brake {
  std::optional<double> gripped_rad{};

  [[nodiscard]] double torque_n_m(const Joint& joint) noexcept {
    constexpr double most_n_m = 30, stiffness_n_m_per_rad = 4000, damping_n_m_s = 100;
    const double motor_rad = joint.motor_rad();
    if (!gripped_rad) gripped_rad = motor_rad;
    const double held_n_m = std::clamp(stiffness_n_m_per_rad * (*gripped_rad - motor_rad), -most_n_m, most_n_m);
    gripped_rad = motor_rad + held_n_m / stiffness_n_m_per_rad;
    return std::clamp(held_n_m - damping_n_m_s * joint.motor_rad_s(), -most_n_m, most_n_m);
  }
};

/// An arm of n joints behind one bus, which a line says before it flies: joints N.
/// To the subsystem: MOTOR_POSITION, MOTOR_VELOCITY, POSITION, VELOCITY, TORQUE DOUBLE[n], TEMPERATURE FLOAT[n], TOOL UINT8 (rad, rad/s, N m, C;
/// what it holds). From it: TORQUE DOUBLE[n] of the motors, TOOL UINT8, which it holds at once.
/// Has every declared stop. A controlled one damps its motors; whenever they are let go brakes grip.
class JointsDevice final : public SimulatedDevice {
 public:
  static constexpr std::size_t most_joints = 16;
  static constexpr std::array fault_lines{FaultLine{"joints 7", "so many joints, at 0.1, 0.2, 0.3 rad and so on"},
                                          FaultLine{"push 1 20", "joint 1 is pushed with 20 N m; 0: no more"}};

  JointsDevice(FlowFactory& flows, const FlowAddress& address, const Settings& settings)
      : SimulatedDevice{flows, address, settings} {
    begin(1);
  }
  [[nodiscard]] bool drives() const noexcept override {
    return std::ranges::any_of(applied_n_m_, [](double torque) { return torque != 0; });
  }

 private:
  /// Each joint stands elsewhere and is lighter than the one before it: who takes one for another is seen.
  void begin(std::size_t joints) noexcept {
    constexpr std::size_t different = 7;
    count_ = joints;
    commanded_n_m_ = applied_n_m_ = {};
    brakes_ = {};
    for (std::size_t i = 0; i < most_joints; ++i) {
      const double at_rad = 0.1 * static_cast<double>(i % different + 1);
      joints_[i] = {.x = {at_rad, 0, at_rad, 0}, .link_inertia_kg_m2 = 0.1 / (1 + 0.5 * static_cast<double>(i))};
    }
  }
  void advance(Duration cycle) noexcept override {
    constexpr double most_n_m = 60, stopping_n_m_s = 60;
    const bool braked = output() == DeviceOutput::Off || output() == DeviceOutput::Holding;
    for (std::size_t i = 0; i < count_; ++i) {
      double torque_n_m = 0;
      if (output() == DeviceOutput::Active) torque_n_m = commanded_n_m_[i];
      if (output() == DeviceOutput::Stopping) torque_n_m = -stopping_n_m_s * joints_[i].motor_rad_s();
      applied_n_m_[i] = std::clamp(torque_n_m, -most_n_m, most_n_m);
      if (!braked) brakes_[i] = {};
      joints_[i].step(applied_n_m_[i] + (braked ? brakes_[i].torque_n_m(joints_[i]) : 0), seconds(cycle));
    }
  }
  Result<> take(OctetReader payload) noexcept override {
    std::array<double, most_joints> torque_n_m{};
    for (std::size_t i = 0; i < count_; ++i) torque_n_m[i] = payload.get<double>();
    const auto tool = payload.get<std::uint8_t>();
    if (!payload.exhausted()) return fail(ErrorCode::Malformed, "command size of so many joints");
    for (std::size_t i = 0; i < count_; ++i) commanded_n_m_[i] = std::isfinite(torque_n_m[i]) ? torque_n_m[i] : 0;
    tool_ = tool;
    return ok();
  }
  void write_sensors(OctetWriter& payload) noexcept override {
    constexpr float ambient_c = 20;
    for (std::size_t i = 0; i < count_; ++i) payload.put(joints_[i].motor_rad());
    for (std::size_t i = 0; i < count_; ++i) payload.put(joints_[i].motor_rad_s());
    for (std::size_t i = 0; i < count_; ++i) payload.put(joints_[i].link_rad());
    for (std::size_t i = 0; i < count_; ++i) payload.put(joints_[i].link_rad_s());
    for (std::size_t i = 0; i < count_; ++i) payload.put(Joint::torque_n_m(joints_[i].x));
    for (std::size_t i = 0; i < count_; ++i) payload.put(ambient_c);
    payload.put(tool_);
  }
  Result<> do_fault(const Words& words) override {
    if (words[0] == "push") {
      HIROSCO_TRY(words.expect(3));
      HIROSCO_TRY_LET(const double joint, words.number(1, 1, static_cast<double>(count_)));
      HIROSCO_TRY_LET(joints_[static_cast<std::size_t>(joint) - 1].push_n_m, words.number(2, -1000, 1000));
      return ok();
    }
    if (words[0] != "joints") return fail(ErrorCode::InvalidArgument, "unknown fault");
    HIROSCO_TRY(words.expect(2));
    HIROSCO_TRY_LET(const double joints, words.number(1, 1, most_joints));
    if (joints != std::floor(joints)) return fail(ErrorCode::InvalidArgument, "a whole number of joints");
    begin(static_cast<std::size_t>(joints));
    return ok();
  }
  std::string do_truth() const override {
    std::string text = fmt::format("joints={} output={} flags={}", count_, static_cast<int>(output()), flags());
    for (std::size_t i = 0; i < count_; ++i)
      text += fmt::format(" q{0}={1:.6f} qd{0}={2:.6f} motor_qd{0}={3:.6f} motor_{0}={4:.4f}", i + 1,
                          joints_[i].link_rad(), joints_[i].link_rad_s(), joints_[i].motor_rad_s(), applied_n_m_[i]);
    return text;
  }
  void do_heal() noexcept override {
    for (Joint& joint : joints_) joint.push_n_m = 0;
  }
  bool can(Stop) const noexcept override { return true; }

  std::size_t count_{0};
  std::array<Joint, most_joints> joints_{};
  std::array<Brake, most_joints> brakes_{};
  std::array<double, most_joints> commanded_n_m_{}, applied_n_m_{};
  std::uint8_t tool_{0};
};

}  // namespace

const hirosco::Module* hirosco_module() noexcept { return &hirosco::simulation::device_module<JointsDevice>; }
