// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "hirosco/utilities/os/installation.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/new_folder/kinds.hpp"

namespace hirosco::tools {
namespace {

namespace fs = std::filesystem;

/// What cmake has to be told, so that it finds the package beside this program; where it looks by itself, nothing.
[[nodiscard]] std::string where_installed(const fs::path& templates) {
  const fs::path share = templates.parent_path().parent_path();
  const fs::path prefix = share.parent_path();
  if (share.filename() != "share" || prefix == "/usr" || prefix == "/usr/local") return {};
  return fmt::format(" -DCMAKE_PREFIX_PATH={}", prefix.string());
}

void say_what_is_next(const NewKind& kind, const std::string& folder, const std::string& installed) {
  fmt::print("  cd {}\n", folder);
  if (kind.compiles) {
    fmt::print("  cmake -B build -DCMAKE_BUILD_TYPE=Release{} && cmake --build build && ctest --test-dir build\n",
               installed);
    fmt::print("  export PATH=$PWD/build:$PATH\n");
  } else {
    fmt::print("  cmake -B build{} && ctest --test-dir build\n", installed);
  }
  fmt::print("  hirosco simulate mission.xml --for 5s\n  hirosco run mission.xml\n");
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
  const fs::path from = find_shipped("templates") / kind->name;
  if (from.is_relative()) {
    fmt::print(stderr, "hirosco new: there are no templates with this program: sudo apt install libhirosco-dev\n");
    return exit_environment;
  }
  const fs::path target = fs::path{options.to} / name->lower;
  const auto made = make_folder(from, target, *name);
  if (!made) {
    fmt::print(stderr, "hirosco new: {}\n", made.error());
    return exit_environment;
  }
  fmt::print("{}: {}\n", target.string(), kind->makes);
  for (const fs::path& file : *made) fmt::print("  {}\n", file.lexically_relative(target).string());
  fmt::print("\nNow:\n");
  say_what_is_next(*kind, target.string(), where_installed(from.parent_path()));
  return exit_ok;
}

}  // namespace hirosco::tools
