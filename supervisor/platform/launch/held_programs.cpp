// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/held_programs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <system_error>
#include <thread>
#include <utility>

#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/utilities/os/installation.hpp"

namespace hirosco::supervisor {
namespace {

[[nodiscard]] Result<ProgramImage> read_program(const std::string& name) {
  const auto file = find_program(name);
  if (file.empty()) return fail(ErrorCode::NotFound, "its executable is neither beside this program nor in PATH");
  return ProgramImage::read(file);
}

[[nodiscard]] StartRefusal of(const Error& why) {
  return {why, why.value == 0 ? std::string{why.text} : fmt::format("{} ({})", why.text, why.value)};
}

}  // namespace

HeldPrograms::HeldPrograms(const descriptor::Mission& mission) : HeldPrograms{mission, read_program} {}

HeldPrograms::HeldPrograms(const descriptor::Mission& mission, Read read)
    : manifest_{mission.manifest.value_or(descriptor::Manifest{})}, mission_{mission.file.string()}, read_{read} {}

StartRefusal HeldPrograms::not_listed(const Wanted& wanted) {
  return {{ErrorCode::NotFound, "its executable is not in the manifest"},
          fmt::format("{} is not in the manifest {}: hirosco manifest {} --write lists what is here", wanted.name,
                      wanted.manifest.string(), wanted.mission)};
}

/// A version that came in flight stands in the manifest as it is now.
std::optional<StartRefusal> HeldPrograms::look_up(Wanted& wanted) {
  if (!wanted.digest.empty()) return std::nullopt;
  const auto manifest = descriptor::read_manifest(wanted.manifest, descriptor::file_system());
  if (!manifest.value)
    return StartRefusal{
        {ErrorCode::Malformed, "the manifest cannot be read"},
        fmt::format("the manifest {} cannot be read: {}", wanted.manifest.string(), manifest.problems.front().message)};
  const auto* listed = manifest.value->find(wanted.name);
  if (listed == nullptr) return not_listed(wanted);
  wanted.digest = listed->digest;
  return std::nullopt;
}

HeldPrograms::Outcome HeldPrograms::check(Read read, Wanted wanted) {
  try {
    if (auto refused = look_up(wanted)) return std::unexpected{std::move(*refused)};
    auto image = read(wanted.name);
    if (!image) return std::unexpected{of(image.error())};
    if (image->digest() == wanted.digest) return std::move(*image);
    return std::unexpected{StartRefusal{
        {ErrorCode::Mismatch, "its digest is not the one in the manifest"},
        fmt::format("{} has the SHA-256 {}, the manifest says {}: put the right file there, or, if this one is "
                    "meant, hirosco manifest {} --write before the next flight",
                    image->file().string(), image->digest(), wanted.digest, wanted.mission)}};
  } catch (const std::bad_alloc&) {
    return std::unexpected{of({ErrorCode::ResourceExhausted, "no memory for an executable"})};
  }
}

std::expected<HeldPrograms::Wanted, StartRefusal> HeldPrograms::wanted(const std::string& name) const {
  Wanted made{name, {}, mission_, manifest_.file};
  if (name.find(descriptor::version_mark) != std::string::npos) return made;
  const auto* listed = manifest_.find(name);
  if (listed == nullptr) return std::unexpected{not_listed(made)};
  made.digest = listed->digest;
  return made;
}

void HeldPrograms::read_all(const descriptor::Mission& mission) {
  for (const descriptor::MissionSubsystem& member : mission.subsystems) {
    const auto listed = wanted(member.executable);
    if (!listed || held_.contains(member.executable)) continue;
    if (auto image = check(read_, *listed)) held_.emplace(member.executable, std::move(*image));
  }
}

void HeldPrograms::read_all_beside(const descriptor::Mission& mission) {
  for (const descriptor::MissionSubsystem& member : mission.subsystems) {
    auto listed = wanted(member.executable);
    if (!listed || held_.contains(member.executable) || read_now_[member.executable].valid()) continue;
    if (!begin_to_read(read_now_[member.executable], std::move(*listed))) return;
  }
}

/// The thread has all that it needs for itself: it may end after this object.
bool HeldPrograms::begin_to_read(std::future<Outcome>& reading, Wanted listed) const {
  std::packaged_task<Outcome()> task{[read = read_, listed = std::move(listed)] { return check(read, listed); }};
  auto outcome = task.get_future();
  try {
    std::thread{std::move(task)}.detach();
  } catch (const std::system_error&) {
    return false;
  }
  reading = std::move(outcome);
  return true;
}

bool HeldPrograms::any_is_read_now() const {
  return std::ranges::any_of(read_now_, [](const auto& entry) {
    return entry.second.valid() && entry.second.wait_for(Duration{0}) != std::future_status::ready;
  });
}

std::expected<const ProgramImage*, StartRefusal> HeldPrograms::find(const std::string& name, Duration patience) {
  if (const auto held = held_.find(name); held != held_.end()) return &held->second;
  auto listed = wanted(name);
  if (!listed) return std::unexpected{std::move(listed.error())};
  // Several that have died at once over a disk that stands still are waited for once: together they would hold up the loop.
  if (any_is_read_now()) patience = Duration{0};
  std::future<Outcome>& reading = read_now_[name];
  if (!reading.valid() && !begin_to_read(reading, std::move(*listed)))
    return std::unexpected{of({ErrorCode::ResourceExhausted, "no thread is left to read its executable"})};
  if (reading.wait_for(patience) != std::future_status::ready)
    return std::unexpected{of({ErrorCode::Unavailable, "its executable is still being read: ask again"})};
  Outcome outcome = reading.get();
  if (!outcome) return std::unexpected{std::move(outcome.error())};
  return &held_.emplace(name, std::move(*outcome)).first->second;
}

std::size_t HeldPrograms::octets() const noexcept {
  std::size_t sum = 0;
  for (const auto& [name, image] : held_) sum += image.octets();
  return sum;
}

}  // namespace hirosco::supervisor
