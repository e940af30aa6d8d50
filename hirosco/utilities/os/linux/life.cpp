// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/life.hpp"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cerrno>
#include <climits>

namespace hirosco {
namespace {

static_assert(most_seen_words == FUTEX_WAITV_MAX);

/// What the system walks when the thread ends: the word stands at a fixed distance from the node, wherever either lies.
struct HeldWord {
  robust_list_head head{};
  robust_list node{};
};
thread_local HeldWord held;

[[nodiscard]] timespec at(Duration monotonic) noexcept {
  constexpr std::int64_t second = 1'000'000'000;
  return {.tv_sec = static_cast<time_t>(monotonic.count() / second),
          .tv_nsec = static_cast<long>(monotonic.count() % second)};
}

}  // namespace

Life life_of(std::uint32_t word) noexcept {
  if ((word & FUTEX_OWNER_DIED) != 0) return Life::Ended;
  return (word & FUTEX_TID_MASK) != 0 ? Life::Held : Life::Unknown;
}

Result<> hold_life(std::atomic<std::uint32_t>& word) noexcept {
  held.node.next = &held.head.list;
  held.head.list.next = &held.node;
  held.head.list_op_pending = nullptr;
  held.head.futex_offset =
      static_cast<long>(std::bit_cast<std::uintptr_t>(&word) - std::bit_cast<std::uintptr_t>(&held.node));
  // Before the system is told of it: a word that it walks to must name this thread, or it is passed over.
  word.store(static_cast<std::uint32_t>(::syscall(SYS_gettid)) | FUTEX_WAITERS, std::memory_order_release);
  if (::syscall(SYS_set_robust_list, &held.head, sizeof held.head) != 0) {
    const int why = errno;
    word.store(0, std::memory_order_release);
    return fail(ErrorCode::Unavailable, "the system keeps no robust list", why);
  }
  wake_waiters(word);
  return ok();
}

Result<> wait_for_change(std::span<const SeenWord> words, Duration limit) noexcept {
  if (words.empty() || words.size() > most_seen_words)
    return fail(ErrorCode::OutOfRange, "words to wait on", static_cast<std::int64_t>(words.size()));
  std::array<futex_waitv, most_seen_words> waits{};
  for (std::size_t i = 0; i < words.size(); ++i)
    waits[i] = {.val = words[i].seen,
                .uaddr = std::bit_cast<std::uintptr_t>(words[i].word),
                .flags = FUTEX_32,
                .__reserved = 0};
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  const timespec until = at(std::chrono::seconds{now.tv_sec} + Duration{now.tv_nsec} + limit);
  if (::syscall(SYS_futex_waitv, waits.data(), static_cast<unsigned>(words.size()), 0U, &until, CLOCK_MONOTONIC) >= 0)
    return ok();
  if (errno == EAGAIN || errno == ETIMEDOUT || errno == EINTR) return ok();
  return fail(ErrorCode::Unavailable, "the system does not wait on several words", errno);
}

void wake_waiters(const std::atomic<std::uint32_t>& word) noexcept {
  static_cast<void>(::syscall(SYS_futex, &word, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0));
}

}  // namespace hirosco
