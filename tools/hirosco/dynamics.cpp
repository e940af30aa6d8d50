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
