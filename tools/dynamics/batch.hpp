// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/utilities/result.hpp"
#include "robotics/dynamics/dynamics.hpp"

/// The model of a robot as a batch tool: JSON lines in, JSON lines out. What they mean stands in `batch_help`.
namespace hirosco::tools {

extern const char* const batch_help;

/// What one line asks for.
struct Motion {
  robotics::Base base{robotics::Base::Fixed};
  robotics::Vector3 gravity_m_s2{robotics::Vector3::Zero()};
  robotics::State state;
  /// Rows of time and torques, straight lines between; one row: always the same.
  struct Row {
    double t_s{0};
    robotics::JointVector torque;
  };
  std::vector<Row> torque;
  double step_s{0};
  double end_s{0};
  std::vector<double> output_s;
};

/// Steps of one line, at most.
inline constexpr double max_steps = 1e8;

/// Reads a line for a robot with so many joints; what is wrong with it in words.
[[nodiscard]] std::expected<Motion, std::string> read_motion(std::string_view line, int joints);

/// Moves robots as lines say.  Thread: one.
class Batch {
 public:
  using Sink = std::function<void(const std::string& line)>;
  /// `model` must outlive this.
  Batch(const robotics::Model& model, robotics::FrameId tip);

  /// Answers line `number` (from 1) with a line for each output time, or what is wrong with it; false: the latter. An empty line
  /// has no answer.
  bool answer(std::string_view line, std::size_t number, const Sink& sink);
  /// What is wrong with a line that cannot be answered; false.
  static bool refuse(const std::string& problem, std::size_t number, const Sink& sink);

 private:
  [[nodiscard]] std::string run(const Motion& motion, const Sink& sink);
  [[nodiscard]] std::string diverged(const Motion& motion);

  const robotics::Model* model_;
  robotics::FrameId tip_;
  robotics::Dynamics fixed_;
  robotics::Dynamics free_;
};

}  // namespace hirosco::tools
