// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/read/brought_files.hpp"

#include <algorithm>
#include <array>

#include "hirosco/descriptor/model/mesh_files.hpp"
#include "hirosco/descriptor/model/setting_files.hpp"

namespace hirosco::descriptor {
namespace {

constexpr std::array bringing_formats{BringingFormat{".urdf", meshes_named}};

void add_once(std::vector<std::filesystem::path>& files, std::filesystem::path file) {
  if (std::ranges::find(files, file) == files.end()) files.push_back(std::move(file));
}

}  // namespace

const BringingFormat* bringing_format_of(const std::filesystem::path& file) {
  const auto found = std::ranges::find(bringing_formats, file.extension().string(), &BringingFormat::extension);
  return found != bringing_formats.end() ? &*found : nullptr;
}

std::vector<std::filesystem::path> brought_files(const SubsystemDescriptor& subsystem, const FileSource& source) {
  std::vector<std::filesystem::path> bringing, brought;
  for (const Configuration& configuration : subsystem.configurations)
    for (const DeviceUse& use : configuration.devices)
      for (const Setting& setting : use.settings)
        if (names_file(setting)) add_once(bringing, file_of(subsystem, setting.value));
  for (const auto& file : bringing) {
    const BringingFormat* const format = bringing_format_of(file);
    if (format == nullptr) continue;
    const auto text = source(file);
    if (!text) continue;
    for (auto& named : format->named(file, *text)) add_once(brought, std::move(named));
  }
  return brought;
}

}  // namespace hirosco::descriptor
