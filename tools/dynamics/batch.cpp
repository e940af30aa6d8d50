// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/dynamics/batch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "robotics/dynamics/integrator.hpp"

namespace hirosco::tools {
namespace {

using robotics::Coordinates;
using robotics::Jacobian;
using robotics::JointVector;
using robotics::MassMatrix;
using robotics::State;
using Json = nlohmann::json;
using Told = nlohmann::ordered_json;

/// A quaternion that is rounded to a few digits is one all the same.
constexpr double unit_tolerance = 1e-3;
/// Of a step: 3 times 0.1 s are 0.3 s, whatever is added up.
constexpr double rounded = 1e-9;

constexpr std::array words{"fixed_base", "gravity_m_s2", "base_position_m", "base_orientation_wxyz", "base_twist",
                           "q",          "qd",           "torque",          "torque_table",          "step_s",
                           "end_s",      "output_s"};

/// Reads members of one object; remembers the first thing that is wrong.
class Members {
 public:
  explicit Members(const Json& object) : object_{object} {}

  [[nodiscard]] bool has(const char* name) const { return object_.contains(name); }
  double number(const char* name) {
    const Json* found = member(name);
    if (found == nullptr) return 0;
    if (!found->is_number()) return wrong("'{}' is no number", name);
    return found->get<double>();
  }
  bool truth(const char* name) {
    const Json* found = member(name);
    if (found == nullptr) return false;
    if (!found->is_boolean()) return wrong("'{}' is neither true nor false", name) > 0;
    return found->get<bool>();
  }
  /// So many numbers; any number of them where `count` is negative.
  /// As many as are wanted, also where something else was found and told. Fewer than none: as many as there are.
  std::vector<double> numbers(const char* name, int count) {
    std::vector<double> found = found_numbers(name, count);
    if (count >= 0) found.resize(static_cast<std::size_t>(count));
    return found;
  }
  std::vector<double> found_numbers(const char* name, int count) {
    const Json* found = member(name);
    return found == nullptr ? std::vector<double>{} : list(*found, name, count);
  }
  std::vector<std::vector<double>> table(const char* name, int columns) {
    const Json* found = member(name);
    std::vector<std::vector<double>> rows;
    if (found == nullptr) return rows;
    if (!found->is_array() || found->empty()) wrong("'{}' is no list of rows", name);
    else
      for (const Json& row : *found) rows.push_back(list(row, name, columns));
    return rows;
  }
  template <class... Args>
  double wrong(fmt::format_string<Args...> text, Args&&... args) {
    if (problem.empty()) problem = fmt::format(text, std::forward<Args>(args)...);
    return 0;
  }

  std::string problem;

 private:
  const Json* member(const char* name) {
    const auto found = object_.find(name);
    if (found != object_.end()) return &*found;
    wrong("'{}' is missing", name);
    return nullptr;
  }
  std::vector<double> list(const Json& array, const char* name, int count) {
    std::vector<double> values;
    if (!array.is_array() || !std::ranges::all_of(array, [](const Json& each) { return each.is_number(); })) {
      wrong("'{}' is no list of numbers", name);
      return std::vector<double>(static_cast<std::size_t>(std::max(count, 0)), 0);
    }
    for (const Json& each : array) values.push_back(each.get<double>());
    if (count >= 0 && values.size() != static_cast<std::size_t>(count)) {
      wrong("'{}' has {} numbers instead of {}", name, values.size(), count);
      values.resize(static_cast<std::size_t>(count), 0);
    }
    return values;
  }

  const Json& object_;
};

[[nodiscard]] JointVector vector_of(const std::vector<double>& values, std::size_t from = 0) {
  return Eigen::Map<const Eigen::VectorXd>(values.data() + from, static_cast<Eigen::Index>(values.size() - from));
}

/// Empty where the line is not one JSON object, each name once; why stands in `problem`.
[[nodiscard]] Json parse(std::string_view line, std::string& problem) {
  std::set<std::string> seen;
  const auto once = [&](int depth, Json::parse_event_t event, Json& key) {
    if (event == Json::parse_event_t::key && depth == 1 && !seen.insert(key.get<std::string>()).second &&
        problem.empty())
      problem = fmt::format("'{}' stands twice", key.get<std::string>());
    return true;
  };
  try {
    Json object = Json::parse(line, once);
    if (!object.is_object() && problem.empty()) problem = "the line is no JSON object";
    return object;
  } catch (const Json::exception& error) {
    // After "[json.exception.parse_error.101] ".
    const std::string_view text = error.what();
    problem = fmt::format("the line is no JSON: {}", text.substr(std::min(text.find("] ") + 2, text.size())));
    return {};
  }
}

void read_torque(Members& members, int joints, Motion& motion) {
  if (members.has("torque") == members.has("torque_table")) {
    members.wrong("{}", members.has("torque") ? "both 'torque' and 'torque_table' are given"
                                              : "'torque' or 'torque_table' is missing");
    return;
  }
  if (members.has("torque")) {
    motion.torque.push_back({0, vector_of(members.numbers("torque", joints))});
    return;
  }
  for (const auto& row : members.table("torque_table", 1 + joints)) {
    if (!motion.torque.empty() && !(row[0] >= motion.torque.back().t_s))
      members.wrong("times in 'torque_table' descend");
    motion.torque.push_back({row[0], vector_of(row, 1)});
  }
}

void check(Members& members, const Motion& motion) {
  if (!(motion.step_s > 0)) members.wrong("'step_s' is not above 0");
  if (!(motion.end_s >= 0)) members.wrong("'end_s' is below 0");
  if (motion.end_s / motion.step_s > max_steps) members.wrong("more than {:g} steps", max_steps);
  if (!std::ranges::is_sorted(motion.output_s)) members.wrong("times in 'output_s' do not ascend");
  if (!motion.output_s.empty() &&
      (motion.output_s.front() < 0 || motion.output_s.back() > motion.end_s + rounded * motion.step_s))
    members.wrong("a time in 'output_s' is not between 0 and 'end_s'");
}

/// Straight lines between rows; before the first and after the last the torque is theirs. Of two of one time the later one counts from then on.
class Table final : public robotics::Integrator::Force {
 public:
  Table(const std::vector<Motion::Row>& rows, int first) : rows_{rows}, first_{first} {}
  void at(double t_s, Coordinates& force) const noexcept override {
    const auto after = std::ranges::upper_bound(rows_, t_s, {}, &Motion::Row::t_s);
    auto torque = force.tail(force.size() - first_);
    if (after == rows_.begin()) torque = rows_.front().torque;
    else if (after == rows_.end()) torque = rows_.back().torque;
    else {
      const auto before = after - 1;
      const double share = (t_s - before->t_s) / (after->t_s - before->t_s);
      torque = (1 - share) * before->torque + share * after->torque;
    }
  }

 private:
  const std::vector<Motion::Row>& rows_;
  int first_;
};

template <class List>
[[nodiscard]] Told list(const List& values) {
  Told::array_t numbers;
  numbers.reserve(static_cast<std::size_t>(values.size()));
  for (Eigen::Index i = 0; i < values.size(); ++i) numbers.emplace_back(values[i]);
  return numbers;
}
template <class Matrix>
[[nodiscard]] Told rows(const Matrix& matrix) {
  Told::array_t all;
  all.reserve(static_cast<std::size_t>(matrix.rows()));
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) all.push_back(list(matrix.row(i)));
  return all;
}

/// Empty: it was told.
[[nodiscard]] std::string tell(double t_s, const State& state, const Coordinates& acceleration,
                               robotics::Dynamics& dynamics, robotics::FrameId tip, const Batch::Sink& sink) {
  dynamics.update(state);
  const auto momentum = dynamics.momentum();
  const double energy = dynamics.kinetic_energy() + dynamics.potential_energy();
  MassMatrix mass;
  Jacobian jacobian, generalised;
  dynamics.mass_matrix(mass);
  dynamics.jacobian(tip, jacobian);
  if (const auto made = dynamics.generalised_jacobian(tip, generalised); !made) return made.error().text;
  const auto& turned = state.base_orientation;
  const bool finite = std::isfinite(energy) && momentum.angular.allFinite() && mass.allFinite() &&
                      jacobian.allFinite() && generalised.allFinite() && acceleration.allFinite() &&
                      state.base_position.allFinite() && state.q.allFinite() && state.qd.allFinite();
  if (!finite) return "a result is no number";
  // All digits that a double has: what reads them gets the same bits.
  sink(Told{{"t", t_s},
            {"base_position_m", list(state.base_position)},
            {"base_orientation_wxyz", {turned.w(), turned.x(), turned.y(), turned.z()}},
            {"base_twist", list(state.base_twist)},
            {"q", list(state.q)},
            {"qd", list(state.qd)},
            {"qdd", list(acceleration.tail(state.q.size()))},
            {"momentum_linear", list(momentum.linear)},
            {"momentum_angular_com", list(momentum.angular)},
            {"energy_j", energy},
            {"mass_matrix", rows(mass)},
            {"jacobian", rows(jacobian)},
            {"generalised_jacobian", rows(generalised)}}
           .dump());
  return {};
}

}  // namespace

const char* const batch_help =
    "Reads one JSON object a line from standard input and writes one for each of its output times to standard "
    "output.\n\n"
    "In, all of it needed:\n"
    "  fixed_base                true or false (false: the base floats)\n"
    "  gravity_m_s2[3]           inertial axes\n"
    "  base_position_m[3]        of the root link's origin, inertial\n"
    "  base_orientation_wxyz[4]  inertial from root link\n"
    "  base_twist[6]             [w; v] of the root link's origin in its own frame; a fixed base rests, whatever is "
    "said\n"
    "  q[], qd[]                 rad or m, rad/s or m/s; joints in URDF order: those that move by themselves, in the "
    "order of\n"
    "                            the file, without fixed ones and without mimic joints, which follow theirs\n"
    "  torque[]                  N m or N, constant; or\n"
    "  torque_table[[t, ...]]    rows of a time and the torques then; times ascend. Torques go in straight lines from "
    "row to row,\n"
    "                            and stay those of the first row before and of the last row after them. Two rows of "
    "one "
    "time are a\n"
    "                            jump: the later one counts from then on\n"
    "  step_s, end_s             of the integration, which begins at 0\n"
    "  output_s[]                ascending, from 0 to end_s\n\n"
    "Out: t, base_position_m, base_orientation_wxyz, base_twist, q, qd, qdd, momentum_linear[3] (inertial axes),\n"
    "momentum_angular_com[3] (inertial axes, about the system's centre of mass), energy_j (kinetic, and potential that "
    "is 0 with\n"
    "the centre of mass at the inertial origin), mass_matrix (of a free base: first its six coordinates [w; v] as in "
    "base_twist),\n"
    "jacobian (rows [w; v] of the tip's origin in inertial axes, columns as the mass matrix), generalised_jacobian "
    "(columns are the\n"
    "joints; what a free robot without momentum does with its tip, of a fixed base the Jacobian). The system is all "
    "links, a fixed\n"
    "root link, too: it counts in centre of mass and energy.\n\n"
    "Integrated by classical Runge-Kutta of fourth order with steps of step_s from 0 on: with a joint that is damped "
    "hard, "
    "steps of\n"
    "more than about 2.8 times its inertia by its damping lead nowhere, and momentum is kept the better the shorter "
    "they "
    "are. An output time between two "
    "steps is\n"
    "reached by one shorter step of the same method from the last one; the steps themselves go on as if it had not "
    "been asked for,\n"
    "so no output depends on others. A bend of a torque_table that is not at a step costs order in that step.\n"
    "<dynamics damping> of the URDF file is applied. Its friction is ignored.\n\n"
    "A bad line is answered with {\"error\", \"line\"}, the rest is gone on with, and the exit code is 1; so is a line "
    "whose motion\n"
    "becomes no number, after what could be told. Empty lines are passed over, one of more than 256 MiB is a bad one. "
    "Where standard\n"
    "input cannot be read the exit code is 3.";

std::expected<Motion, std::string> read_motion(std::string_view line, int joints) {
  std::string problem;
  const Json object = parse(line, problem);
  if (!problem.empty()) return std::unexpected(problem);
  Members members{object};
  for (const auto& [name, value] : object.items())
    if (std::ranges::find(words, name) == words.end()) members.wrong("'{}' is not known", name);
  Motion motion;
  motion.base = members.truth("fixed_base") ? robotics::Base::Fixed : robotics::Base::Free;
  motion.gravity_m_s2 = vector_of(members.numbers("gravity_m_s2", 3));
  motion.state.base_position = vector_of(members.numbers("base_position_m", 3));
  const auto turned = members.numbers("base_orientation_wxyz", 4);
  motion.state.base_twist = vector_of(members.numbers("base_twist", 6));
  if (motion.base == robotics::Base::Fixed) motion.state.base_twist.setZero();
  motion.state.q = vector_of(members.numbers("q", joints));
  motion.state.qd = vector_of(members.numbers("qd", joints));
  read_torque(members, joints, motion);
  motion.step_s = members.number("step_s");
  motion.end_s = members.number("end_s");
  motion.output_s = members.numbers("output_s", -1);
  if (!members.problem.empty()) return std::unexpected(members.problem);
  const robotics::Quaternion orientation{turned[0], turned[1], turned[2], turned[3]};
  if (!(std::abs(orientation.norm() - 1) <= unit_tolerance))
    members.wrong("'base_orientation_wxyz' is not of length 1");
  motion.state.base_orientation = orientation.normalized();
  check(members, motion);
  if (!members.problem.empty()) return std::unexpected(members.problem);
  return motion;
}

Batch::Batch(const robotics::Model& model, robotics::FrameId tip)
    : model_{&model}, tip_{tip}, fixed_{model, robotics::Base::Fixed}, free_{model, robotics::Base::Free} {}

bool Batch::answer(std::string_view line, std::size_t number, const Sink& sink) {
  if (line.find_first_not_of(" \t\r") == std::string_view::npos) return true;
  const auto motion = read_motion(line, model_->joint_count());
  const std::string problem = motion ? run(*motion, sink) : motion.error();
  return problem.empty() || refuse(problem, number, sink);
}

bool Batch::refuse(const std::string& problem, std::size_t number, const Sink& sink) {
  sink(Json{{"error", problem}, {"line", number}}.dump(-1, ' ', false, Json::error_handler_t::replace));
  return false;
}

/// Of a motion that has begun: it could be told where it begins, so that what became of it is the step's. A step of this method bears a damped joint
/// that follows nothing else up to 2.78 of its time constant.
std::string Batch::diverged(const Motion& motion) {
  constexpr double time_constants = 2.785;
  robotics::Dynamics& dynamics = motion.base == robotics::Base::Fixed ? fixed_ : free_;
  dynamics.update(motion.state);
  MassMatrix mass;
  dynamics.mass_matrix(mass);
  const Eigen::VectorXd mobility = mass.inverse().diagonal().tail(model_->joint_count());
  double longest_s = HUGE_VAL;
  for (int i = 0; i < model_->joint_count(); ++i) {
    const double per_s = model_->joints()[static_cast<std::size_t>(i)].damping * mobility[i];
    if (per_s > 0) longest_s = std::min(longest_s, time_constants / per_s);
  }
  const std::string said = "the motion has become no number";
  if (motion.step_s < longest_s) return said + ": the step may be too long for it";
  return said + fmt::format(": the damping of its joints bears steps up to about {:.2g} s, not {:g} s", longest_s,
                            motion.step_s);
}

std::string Batch::run(const Motion& motion, const Sink& sink) {
  robotics::Dynamics& dynamics = motion.base == robotics::Base::Fixed ? fixed_ : free_;
  dynamics.set_gravity(motion.gravity_m_s2);
  robotics::Integrator integrator{dynamics};
  const Table torque{motion.torque, dynamics.coordinate_count() - model_->joint_count()};
  State state = motion.state;
  Coordinates acceleration;
  auto output = motion.output_s.begin();
  const auto at_step = [&motion](double step) { return step * motion.step_s; };
  if (const auto known = integrator.acceleration(state, 0, torque, acceleration); !known) return known.error().text;
  for (double step = 0;; ++step) {
    const double now = at_step(step), next = at_step(step + 1);
    for (; output != motion.output_s.end() && *output < next; ++output) {
      State then = state;
      if (*output > now)
        if (!integrator.step(then, now, *output - now, torque)) return diverged(motion);
      if (!integrator.acceleration(then, *output, torque, acceleration)) return diverged(motion);
      if (auto problem = tell(*output, then, acceleration, dynamics, tip_, sink); !problem.empty()) return problem;
    }
    if (output == motion.output_s.end()) return {};
    if (!integrator.step(state, now, next - now, torque)) return diverged(motion);
  }
}

}  // namespace hirosco::tools
