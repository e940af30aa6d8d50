// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/held_programs.hpp"

#include <fmt/format.h>

#include <new>
#include <system_error>
#include <thread>
#include <utility>

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

HeldPrograms::Outcome HeldPrograms::check(Read read, const Wanted& wanted) {
  try {
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
  if (const auto* listed = manifest_.find(name)) return Wanted{name, listed->digest, mission_};
  return std::unexpected{StartRefusal{
      {ErrorCode::NotFound, "its executable is not in the manifest"},
      fmt::format("{} is not in the manifest {}: hirosco manifest {} --write before the next flight lists what is here",
                  name, manifest_.file.string(), mission_)}};
}

void HeldPrograms::read_all(const descriptor::Mission& mission) {
  for (const descriptor::MissionSubsystem& member : mission.subsystems) {
    const auto listed = wanted(member.executable);
    if (!listed || held_.contains(member.executable)) continue;
    if (auto image = check(read_, *listed)) held_.emplace(member.executable, std::move(*image));
  }
}

std::expected<const ProgramImage*, StartRefusal> HeldPrograms::find(const std::string& name) {
  if (const auto held = held_.find(name); held != held_.end()) return &held->second;
  auto listed = wanted(name);
  if (!listed) return std::unexpected{std::move(listed.error())};
  std::future<Outcome>& reading = read_now_[name];
  try {
    if (!reading.valid()) {
      std::packaged_task<Outcome()> task{[read = read_, listed = std::move(*listed)] { return check(read, listed); }};
      reading = task.get_future();
      std::thread{std::move(task)}.detach();
    }
  } catch (const std::system_error&) {
    reading = {};
    return std::unexpected{of({ErrorCode::ResourceExhausted, "no thread is left to read its executable"})};
  }
  if (reading.wait_for(longest_wait) != std::future_status::ready)
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
