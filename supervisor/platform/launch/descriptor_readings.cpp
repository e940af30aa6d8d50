// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/descriptor_readings.hpp"

#include <system_error>
#include <thread>
#include <utility>

namespace hirosco::supervisor {

DescriptorReading read_now(const descriptor::Mission& flown, const std::filesystem::path& file,
                           const descriptor::FileSource& source) {
  DescriptorReading reading;
  auto text = source(file);
  if (!text) {
    reading.mission.problems.push_back({.file = file,
                                        .at = {},
                                        .code = "E0001",
                                        .message = text.error().text,
                                        .hint = "a regular, readable file of at most 4 MiB is needed"});
    return reading;
  }
  reading.text = std::make_shared<const std::string>(std::move(*text));
  reading.mission = descriptor::read_again(flown, file, *reading.text, source);
  return reading;
}

Result<> ThreadedReadings::begin(const descriptor::Mission& flown, const std::filesystem::path& file) {
  if (reading_.valid()) return fail(ErrorCode::Unavailable, "another descriptor is being read");
  descriptor::Mission files;  // all that it is judged by
  files.file = flown.file;
  files.texts = flown.texts;
  try {
    std::packaged_task<DescriptorReading()> task{
        [files = std::move(files), file] { return read_now(files, file, descriptor::file_system()); }};
    reading_ = task.get_future();
    std::thread{std::move(task)}.detach();
  } catch (const std::system_error&) {
    reading_ = {};
    return fail(ErrorCode::ResourceExhausted, "no thread is left to read a descriptor");
  }
  return ok();
}

std::optional<DescriptorReading> ThreadedReadings::outcome() {
  if (!reading_.valid() || reading_.wait_for(std::chrono::seconds{0}) != std::future_status::ready) return std::nullopt;
  return reading_.get();
}

}  // namespace hirosco::supervisor
