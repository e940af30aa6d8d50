// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/programs_in_use.hpp"

#include <utility>

#include "hirosco/utilities/os/installation.hpp"

namespace hirosco::supervisor {
namespace {

[[nodiscard]] std::string version_of(const std::string& executable, const std::string& version) {
  return version.empty() ? executable : executable + descriptor::version_mark + version;
}

}  // namespace

const HeldPrograms& ProgramsInUse::hold_to(const descriptor::Mission& mission) {
  held_ = std::make_unique<HeldPrograms>(mission);
  held_->read_all(mission);
  return *held_;
}

void ProgramsInUse::hold_to_beside(const descriptor::Mission& mission) {
  held_ = std::make_unique<HeldPrograms>(mission);
  held_->read_all_beside(mission);
}

Result<ProgramsInUse::Found> ProgramsInUse::find(const descriptor::MissionSubsystem& subsystem) {
  if (held_) {
    const auto image = held_->find(name_of(subsystem));
    if (!image) return fail(image.error().why);
    return Found{(*image)->file(), (*image)->interpreter(), *image};
  }
  Found& found = files_[subsystem.executable];
  if (found.file.empty()) {
    found.file = find_program(subsystem.executable);
    found.interpreter = interpreter_of(found.file);
  }
  if (found.file.empty()) return fail(ErrorCode::NotFound, "its executable is neither beside this program nor in PATH");
  return found;
}

std::optional<StartRefusal> ProgramsInUse::refuse(const descriptor::MissionSubsystem& subsystem) {
  if (!held_) return std::nullopt;
  auto found = held_->find(name_of(subsystem));
  return found ? std::nullopt : std::optional{std::move(found.error())};
}

std::string ProgramsInUse::name_of(const descriptor::MissionSubsystem& subsystem) const {
  const auto version = versions_.find(subsystem.subsystem.name);
  return version == versions_.end() ? subsystem.executable : version_of(subsystem.executable, version->second);
}

std::expected<bool, StartRefusal> ProgramsInUse::prepare(const descriptor::MissionSubsystem& subsystem,
                                                         const std::string& version) {
  auto found = held_->find(version_of(subsystem.executable, version), Duration{0});
  if (found) return true;
  if (found.error().why.code == ErrorCode::Unavailable) return false;
  return std::unexpected{std::move(found.error())};
}

void ProgramsInUse::use(const descriptor::MissionSubsystem& subsystem, const std::string& version) {
  if (version.empty()) versions_.erase(subsystem.subsystem.name);
  else versions_[subsystem.subsystem.name] = version;
}

void ProgramsInUse::drop(const descriptor::MissionSubsystem& subsystem, const std::string& version) {
  if (held_ && !version.empty()) held_->drop(version_of(subsystem.executable, version));
}

}  // namespace hirosco::supervisor
