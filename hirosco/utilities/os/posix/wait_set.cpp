// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/wait_set.hpp"

#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <ctime>
#include <limits>

namespace hirosco {
namespace {

[[nodiscard]] short events_of(Interest interest) noexcept {
  switch (interest) {
    case Interest::Read: return POLLIN;
    case Interest::Write: return POLLOUT;
    case Interest::ReadWrite: return POLLIN | POLLOUT;
    case Interest::HangUpOnly: return 0;
  }
  return 0;
}

[[nodiscard]] Duration monotonic() noexcept {
  timespec value{};
  (void)clock_gettime(CLOCK_MONOTONIC, &value);
  return std::chrono::seconds{value.tv_sec} + Duration{value.tv_nsec};
}

/// Rounded up, so that a wait never ends early and then spins.
[[nodiscard]] int poll_milliseconds(Duration span) noexcept {
  const auto whole = std::chrono::ceil<std::chrono::milliseconds>(span).count();
  return static_cast<int>(std::clamp<std::int64_t>(whole, 0, std::numeric_limits<int>::max()));
}

}  // namespace

Result<> WaitSet::add(int descriptor, Interest interest) {
  if (descriptor < 0) return fail(ErrorCode::InvalidArgument, "descriptor to wait for", descriptor);
  if (index_of(descriptor) != entries_.size())
    return fail(ErrorCode::AlreadyExists, "descriptor to wait for", descriptor);
  if (entries_.size() == max_descriptors) return fail(ErrorCode::ResourceExhausted, "descriptors to wait for");
  entries_.push_back({descriptor, events_of(interest), 0});
  ready_.reserve(entries_.capacity());
  return ok();
}

Result<> WaitSet::change(int descriptor, Interest interest) noexcept {
  const std::size_t index = index_of(descriptor);
  if (index == entries_.size()) return fail(ErrorCode::NotFound, "descriptor to wait for", descriptor);
  entries_[index].events = events_of(interest);
  return ok();
}

void WaitSet::remove(int descriptor) noexcept {
  const std::size_t index = index_of(descriptor);
  if (index != entries_.size()) entries_.erase(entries_.begin() + static_cast<std::ptrdiff_t>(index));
}

std::size_t WaitSet::size() const noexcept { return entries_.size(); }

std::size_t WaitSet::index_of(int descriptor) const noexcept {
  return static_cast<std::size_t>(std::ranges::find(entries_, descriptor, &Entry::descriptor) - entries_.begin());
}

Result<std::span<const Ready>> WaitSet::wait(std::optional<Duration> timeout) noexcept {
  static_assert(sizeof(Entry) == sizeof(pollfd) && offsetof(Entry, descriptor) == offsetof(pollfd, fd) &&
                offsetof(Entry, events) == offsetof(pollfd, events) &&
                offsetof(Entry, returned) == offsetof(pollfd, revents));
  ready_.clear();
  const Duration start = monotonic();
  int found = 0;
  for (;;) {
    const int limit = timeout ? poll_milliseconds(*timeout - (monotonic() - start)) : -1;
    found = ::poll(reinterpret_cast<pollfd*>(entries_.data()), static_cast<nfds_t>(entries_.size()), limit);
    if (found >= 0) break;
    if (errno != EINTR) return fail(ErrorCode::SystemFailure, "wait for descriptors", errno);
  }
  if (found == 0) return std::span<const Ready>{};
  for (const Entry& entry : entries_)
    if (entry.returned != 0)
      ready_.push_back({entry.descriptor, (entry.returned & POLLIN) != 0, (entry.returned & POLLOUT) != 0,
                        (entry.returned & (POLLHUP | POLLERR | POLLNVAL)) != 0});
  return std::span<const Ready>{ready_};
}

}  // namespace hirosco
