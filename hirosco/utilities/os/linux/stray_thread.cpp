// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/stray_thread.hpp"

#include <unistd.h>

#include <array>
#include <string_view>

#include "hirosco/utilities/os/process_threads.hpp"

namespace hirosco {
namespace {

constexpr int most_looked_at = 256;

/// As the tools of the system show it; empty: it has ended.
[[nodiscard]] std::array<char, 16> name_of(const ProcessThreads& threads, int thread) noexcept {
  std::array<char, 16> name{};
  const FileDescriptor text = threads.open(thread, "comm");
  const auto octets = text ? ::read(text.get(), name.data(), name.size()) : 0;
  // It ends with a new line, which a name of 15 octets leaves room for.
  if (octets > 0) name[static_cast<std::size_t>(octets) - 1] = '\0';
  return name;
}

[[nodiscard]] std::optional<StrayThread> look(const ProcessThreads& threads, int thread,
                                              const ThreadPlaces& places) noexcept {
  const ProcessorSet used = ProcessorSet::of_thread(thread);
  auto beyond = used.beyond(places.all);
  if (!beyond && places.cycle) {
    ProcessorSet own;
    own.add(*places.cycle);
    beyond = used.beyond(own);
    if (beyond && std::string_view{name_of(threads, thread).data()} != ThreadPlaces::cycle_name) return std::nullopt;
  }
  if (!beyond) return std::nullopt;
  return StrayThread{.name = name_of(threads, thread), .processor = *beyond};
}

}  // namespace

std::optional<StrayThread> stray_thread(int process, const ThreadPlaces& places) noexcept {
  ProcessThreads threads = ProcessThreads::of(process);
  std::optional<StrayThread> found;
  int looked_at = 0;
  threads.each([&](int thread) {
    if (!found && ++looked_at <= most_looked_at) found = look(threads, thread, places);
  });
  return found;
}

}  // namespace hirosco
