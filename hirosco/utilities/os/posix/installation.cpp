// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/installation.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <new>

namespace hirosco {

namespace fs = std::filesystem;

namespace {

/// Where programs are looked for.
[[nodiscard]] std::vector<fs::path> program_folders() {
  std::vector<fs::path> folders;
  if (const auto self = this_program(); !self.empty()) folders.push_back(self.parent_path());
  const char* path = std::getenv("PATH");
  std::string_view rest = path != nullptr ? path : "";
  while (!rest.empty()) {
    const auto colon = rest.find(':');
    folders.emplace_back(rest.substr(0, colon));
    rest = colon == std::string_view::npos ? std::string_view{} : rest.substr(colon + 1);
  }
  return folders;
}

[[nodiscard]] std::string_view text_of(ModuleKind kind) {
  return kind == ModuleKind::Subsystem ? "subsystem" : "simulated device";
}

/// Why this module is not taken; empty when it is.
[[nodiscard]] std::string refuse(const Module& module, ModuleKind kind) {
  if (module.magic != module_magic) return "its hirosco_module() tells of no module";
  const std::string_view built{module.interface};
  if (built != interface_version)
    return "it was built against hirosco " + std::string{built} + ", this is " + interface_version +
           ": build it again; where that does not help what it is built with is of another build: "
           "install hirosco and libhirosco-dev of one build";
  if (module.standard_library != standard_library_release)
    return "it was built with libstdc++ " + std::to_string(module.standard_library) + ", this program with " +
           std::to_string(standard_library_release) + ": build it with the same compiler";
  if (module.kind != kind) return "it is no " + std::string{text_of(kind)};
  return {};
}

}  // namespace

fs::path this_program() {
  // Empty where the system does not tell it there.
  std::error_code failed;
  return fs::read_symlink("/proc/self/exe", failed);
}

fs::path find_program(std::string_view name) {
  std::error_code failed;
  for (const fs::path& folder : program_folders())
    if (const auto program = folder / name; fs::is_regular_file(program, failed)) return program;
  return {};
}

fs::path find_module(std::string_view name) {
  std::error_code failed;
  const std::string file = std::string{name} + ".so";
  for (const fs::path& folder : program_folders())
    for (const fs::path& candidate : {folder / file, folder.parent_path() / "lib" / "hirosco" / file})
      if (fs::is_regular_file(candidate, failed)) return candidate;
  return {};
}

std::vector<fs::path> shipped_folders() {
  std::vector<fs::path> folders;
  for (fs::path folder = this_program().parent_path(); !folder.empty(); folder = folder.parent_path()) {
    folders.push_back(folder / "share" / "hirosco");
    folders.push_back(folder);
    if (!folder.has_relative_path()) break;
  }
  return folders;
}

fs::path find_shipped(std::string_view name) {
  std::error_code failed;
  for (const fs::path& folder : shipped_folders())
    if (const auto candidate = folder / name; fs::exists(candidate, failed)) return candidate;
  return {};
}

std::expected<const Module*, std::string> load_module_of(std::string_view program, ModuleKind kind) {
  const fs::path file = find_module(program);
  if (file.empty())
    return std::unexpected{"there is no " + std::string{program} +
                           ".so beside this program, in its ../lib/hirosco, or so in PATH"};
  auto loaded = load_module(file, kind);
  if (!loaded) return std::unexpected{file.string() + ": " + loaded.error()};
  return loaded;
}

std::expected<const Module*, std::string> load_module(const fs::path& file, ModuleKind kind) {
  if (!os_detail::module_is_whole(file))
    return std::unexpected{std::string{"it is no shared object, or was cut short"}};
  // Never unloaded: objects that it made may live as long as the process.
  void* const module = ::dlopen(fs::absolute(file).c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (module == nullptr) {
    // A computer without memory is told as such, whoever asks it for some; the loader does not tell it from other reasons.
    if (!os_detail::has_room_for_module(file)) throw std::bad_alloc{};
    return std::unexpected{std::string{::dlerror()}};
  }
  const auto entry = reinterpret_cast<decltype(&hirosco_module)>(::dlsym(module, "hirosco_module"));
  if (entry == nullptr) return std::unexpected{std::string{"it has no hirosco_module()"}};
  const Module* const told = entry();
  if (told == nullptr) return std::unexpected{std::string{"its hirosco_module() tells nothing"}};
  if (const auto why = refuse(*told, kind); !why.empty()) return std::unexpected{why};
  return told;
}

}  // namespace hirosco
