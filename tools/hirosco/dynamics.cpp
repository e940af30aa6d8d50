// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <string>

#include "robotics/urdf/robot.hpp"
#include "tools/dynamics/batch.hpp"
#include "tools/dynamics/lines.hpp"
#include "tools/hirosco/commands.hpp"

namespace hirosco::tools {
namespace {

/// Longer lines are refused: a table of torques with a million rows is shorter.
constexpr std::size_t octets_of_mib = 1024U * 1024, max_line_mib = 256;

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

/// How many joints move that link.
[[nodiscard]] std::size_t joints_before(const robotics::urdf::Robot& robot, const std::string& link) {
  std::size_t moving = 0;
  auto at =
      static_cast<std::size_t>(std::ranges::find(robot.links, link, &robotics::urdf::Link::name) - robot.links.begin());
  while (at != robot.root) {
    const auto& joint = *std::ranges::find(robot.joints, at, &robotics::urdf::Joint::child);
    moving += joint.type == robotics::urdf::JointType::Fixed ? 0 : 1;
    at = joint.parent;
  }
  return moving;
}

/// Where none is named, the end that most joints move, the first in the file of several: told where there is a choice. Empty: told why.
[[nodiscard]] std::string tip_of(const robotics::urdf::Robot& robot, const std::string& named) {
  const auto ends = robotics::urdf::tips(robot);
  const auto known = [&](const std::string& link) {
    return std::ranges::find(robot.links, link, &robotics::urdf::Link::name) != robot.links.end();
  };
  if (!named.empty() && known(named)) return named;
  if (!named.empty()) {
    fmt::print(stderr, "hirosco dynamics: {} has no link {}; links at the ends are: {}\n", robot.name, named,
               fmt::join(ends, ", "));
    return {};
  }
  const std::string& farthest =
      *std::ranges::max_element(ends, {}, [&](const std::string& end) { return joints_before(robot, end); });
  if (ends.size() > 1)
    fmt::print(
        stderr,
        "hirosco dynamics: {} ends in {} links: the tip is {}, which most joints move; --tip names another of {}\n",
        robot.name, ends.size(), farthest, fmt::join(ends, ", "));
  return farthest;
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
  BoundedLines lines{stdin, max_line_mib * octets_of_mib};
  auto next = lines.next();
  for (std::size_t number = 1; next == BoundedLines::Next::Line || next == BoundedLines::Next::TooLong; ++number) {
    if (next == BoundedLines::Next::Line) good = batch.answer(lines.line(), number, print) && good;
    else good = Batch::refuse(fmt::format("the line is longer than {} MiB", max_line_mib), number, print);
    std::cout.flush();
    next = lines.next();
  }
  if (next == BoundedLines::Next::Failed) {
    fmt::print(stderr, "hirosco dynamics: standard input cannot be read: {}\n", std::strerror(errno));
    return exit_environment;
  }
  return good ? exit_ok : exit_finding;
}

}  // namespace hirosco::tools
