// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <string>

#include "robotics/urdf/robot.hpp"
#include "tools/dynamics/batch.hpp"
#include "tools/hirosco/commands.hpp"

namespace hirosco::tools {
namespace {

/// Longer lines are refused: a table of torques with a million rows is shorter.
constexpr std::size_t max_line_octets = 256U * 1024 * 1024;

/// Nothing: told why.
[[nodiscard]] std::optional<robotics::urdf::Robot> load(const std::string& file) {
  const auto source = descriptor::file_system();
  auto reading = robotics::urdf::read(file, source);
  const bool colour = ::isatty(STDERR_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr;
  for (const auto* list : {&reading.problems, &reading.warnings})
    for (const auto& problem : *list) fmt::print(stderr, "{}", descriptor::render(problem, source, colour));
  if (!reading.value)
    fmt::print(stderr, "hirosco dynamics: {} is not taken; codes are explained in {}\n", file,
               document("urdf-errors.md"));
  return std::move(reading.value);
}

/// The only one there is, where none is named. Empty: told why.
[[nodiscard]] std::string tip_of(const robotics::urdf::Robot& robot, const std::string& named) {
  const auto ends = robotics::urdf::tips(robot);
  if (named.empty() && ends.size() == 1) return ends.front();
  if (!named.empty() && std::ranges::find(robot.links, named, &robotics::urdf::Link::name) != robot.links.end())
    return named;
  fmt::print(stderr, "hirosco dynamics: {}; links at the ends are: {}\n",
             named.empty() ? fmt::format("{} ends in {} links: name one with --tip", robot.name, ends.size())
                           : fmt::format("{} has no link {}", robot.name, named),
             fmt::join(ends, ", "));
  return {};
}

}  // namespace

int dynamics(const DynamicsOptions& options) {
  const auto robot = load(options.model);
  if (!robot) return exit_finding;
  const std::string tip = tip_of(*robot, options.tip);
  if (tip.empty()) return exit_usage;
  const auto model = robotics::Model::make(robotics::urdf::describe(*robot));
  if (!model) {
    fmt::print(stderr, "hirosco dynamics: {}: {}\n", options.model, model.error().text);
    return exit_finding;
  }
  const bool rubs = std::ranges::any_of(model->joints(), [](const auto& joint) { return joint.friction > 0; });
  if (rubs) fmt::print(stderr, "hirosco dynamics: {}: the friction of joints is ignored\n", options.model);
  Batch batch{*model, *model->find_frame(tip)};
  const auto print = [](const std::string& line) { std::cout << line << '\n'; };
  bool good = true;
  std::string line;
  for (std::size_t number = 1; std::getline(std::cin, line); ++number) {
    if (line.size() > max_line_octets) line = "too long";
    good = batch.answer(line, number, print) && good;
    std::cout.flush();
  }
  return good ? exit_ok : exit_finding;
}

}  // namespace hirosco::tools
