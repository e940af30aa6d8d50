// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "hirosco/utilities/os/installation.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/new_folder/kinds.hpp"
#include "tools/new_folder/robot.hpp"
#include "tools/new_folder/robot_world.hpp"

namespace hirosco::tools {
namespace {

namespace fs = std::filesystem;

/// Whether what builds and tests a folder is beside this program: an installation may go without.
[[nodiscard]] bool can_be_built(const fs::path& templates) {
  const fs::path share = templates.parent_path().parent_path();
  return share.filename() != "share" || fs::exists(share.parent_path() / "lib/cmake/hirosco");
}

/// What cmake has to be told, so that it finds the package beside this program; where it looks by itself, nothing.
[[nodiscard]] std::string where_installed(const fs::path& templates) {
  const fs::path share = templates.parent_path().parent_path();
  const fs::path prefix = share.parent_path();
  if (share.filename() != "share" || prefix == "/usr" || prefix == "/usr/local") return {};
  return fmt::format(" -DCMAKE_PREFIX_PATH={}", prefix.string());
}

/// cmake takes make by itself, also where there is ninja alone.
[[nodiscard]] std::string generator() {
  const bool told = std::getenv("CMAKE_GENERATOR") != nullptr;
  return !told && find_program("make").empty() && !find_program("ninja").empty() ? " -G Ninja" : "";
}

void say_what_is_next(const NewKind& kind, const std::string& folder, const std::string& installed, bool builds) {
  if (kind.compiles && !builds) fmt::print("  sudo apt install libhirosco-dev    # what builds it\n");
  fmt::print("  cd {}\n", folder);
  if (kind.compiles) {
    fmt::print("  cmake -B build -DCMAKE_BUILD_TYPE=Release{} && cmake --build build && ctest --test-dir build\n",
               installed);
    fmt::print("  export PATH=$PWD/build:$PATH    # in each terminal: hirosco finds programs and their faults by it\n");
  } else if (builds) {
    fmt::print("  cmake -B build{} && ctest --test-dir build\n", installed);
  }
  fmt::print("  hirosco simulate mission.xml --for 5s\n  hirosco run mission.xml\n");
}

/// Where packages are whose meshes a file names: those that were said, then those of ROS, where there is any.
[[nodiscard]] std::vector<fs::path> package_folders(const NewOptions& options) {
  std::vector<fs::path> folders{options.packages.begin(), options.packages.end()};
  for (const auto& [variable, below] : {std::pair{"ROS_PACKAGE_PATH", ""}, {"AMENT_PREFIX_PATH", "share"}}) {
    const char* value = std::getenv(variable);
    std::istringstream listed{value != nullptr ? value : ""};
    for (std::string folder; std::getline(listed, folder, ':');)
      if (!folder.empty()) folders.push_back(fs::path{folder} / below);
  }
  return folders;
}

/// Of a file of one's own, or of the one that comes with the template. Nothing: told why.
[[nodiscard]] std::optional<NewParts> parts_of_robot(const NewOptions& options, const NewName& name,
                                                     const fs::path& from) {
  const auto source = descriptor::file_system();
  const fs::path file = options.urdf.empty() ? referred(from, "page/newpart.urdf") : fs::path{options.urdf};
  JudgedRobot judged = judge_robot(file, source, options.tip, options.gripper, package_folders(options), options.chain);
  const bool colour = ::isatty(STDERR_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr;
  for (const auto* list : {&judged.problems, &judged.warnings})
    for (const auto& problem : *list) fmt::print(stderr, "{}", descriptor::render(problem, source, colour));
  if (!judged.robot) {
    fmt::print(stderr, "hirosco new: {} cannot be flown; codes are explained in {}\n", file.string(),
               document("urdf-errors.md"));
    return std::nullopt;
  }
  if (options.urdf.empty()) judged.robot->urdf = without_licence(judged.robot->urdf);
  return parts_of(*judged.robot, name, {.homing = options.homing, .wrist_sensor = options.wrist_sensor});
}

[[nodiscard]] bool says_of_a_robot(const NewOptions& options) {
  return !(options.urdf.empty() && options.tip.empty() && options.gripper.empty() && options.packages.empty()) ||
         options.chain || options.homing || options.wrist_sensor;
}

/// Whoever makes a subsystem of a name that a ready one has may want that one.
void say_what_is_ready(const NewName& name) {
  const fs::path ready = find_shipped("subsystems/" + name.lower);
  if (ready.empty()) return;
  fmt::print("\nA ready subsystem of this name comes with HIROSCO: {}\nWhat is made here is another one.\n",
             ready.string());
}

/// Its world is none of the parts that everybody has.
void say_what_is_missing(const fs::path& templates) {
  const RobotWorld world = robot_world(templates);
  if (world.program.empty() || !find_program(world.program).empty()) return;
  fmt::print(
      "\nIts world, {}, is not here: the package {} has it. It is built with HIROSCO's sources once\n"
      "tools/{} has fetched its physics (10 MB, judged by hash); until then the mission can be checked, but not "
      "flown.\n",
      world.program, world.package, world.fetcher);
}

}  // namespace

int make_new(const NewOptions& options) {
  const auto kinds = new_kinds();
  const auto kind = std::ranges::find_if(kinds, [&](const NewKind& one) { return options.kind == one.name; });
  const auto name = new_name(options.name);
  if (!name) {
    fmt::print(stderr, "hirosco new: '{}' is no name for it: {}\n", options.name, name.error());
    return exit_usage;
  }
  if (!kind->of_urdf && says_of_a_robot(options)) {
    fmt::print(
        stderr,
        "hirosco new: --urdf, --tip, --gripper, --chain, --homing, --wrist-sensor and --packages are of a robot: "
        "hirosco new robot {} --urdf FILE\n",
        options.name);
    return exit_usage;
  }
  if (options.chain && options.tip.empty() && options.gripper.empty()) {
    fmt::print(stderr, "hirosco new: --chain is of a tool: --tip LINK --chain\n");
    return exit_usage;
  }
  const fs::path from = find_shipped("templates") / kind->name;
  if (from.is_relative()) {
    fmt::print(stderr, "hirosco new: there are no templates with this program: sudo apt install --reinstall hirosco\n");
    return exit_environment;
  }
  if (carries_ground_link(from, *name)) {
    fmt::print(stderr,
               "hirosco new: '{}' is no name for it: what carries the ground link of its mission is called so\n",
               options.name);
    return exit_usage;
  }
  const fs::path target = fs::path{options.to} / name->lower;
  NewParts parts;
  if (kind->of_urdf) {
    auto found = parts_of_robot(options, *name, from);
    if (!found) return exit_finding;
    parts = std::move(*found);
  }
  const auto made = make_folder(from, target, *name, parts);
  if (!made) {
    fmt::print(stderr, "hirosco new: {}\n", made.error());
    return exit_environment;
  }
  fmt::print("{}: {}\n", target.string(), kind->makes);
  for (const fs::path& file : *made) fmt::print("  {}\n", file.lexically_relative(target).string());
  if (kind->of_urdf) say_what_is_missing(from.parent_path());
  else say_what_is_ready(*name);
  fmt::print("\nNow:\n");
  say_what_is_next(*kind, target.string(), generator() + where_installed(from.parent_path()),
                   can_be_built(from.parent_path()));
  return exit_ok;
}

}  // namespace hirosco::tools
