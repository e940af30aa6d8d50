// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "hirosco/utilities/result.hpp"

namespace hirosco {

/// So many of a thing may be held at once and no more: ports, files (paper 4.1: "each subsystem must acquire its resources via the
/// resource management library"). Counts what is held, the most that ever was, and what was refused.
/// All of it: Realtime: lock-free. Thread: any.
class Quota {
 public:
  /// One that is held. It is given back with the end of this object, whichever of both ends first: an author's parts live longer than what counts
  /// them.
  class Held {
   public:
    /// Nothing.
    Held() noexcept = default;
    Held(Held&& other) noexcept : used_{std::move(other.used_)} {}
    Held& operator=(Held&& other) noexcept {
      std::swap(used_, other.used_);
      return *this;
    }
    ~Held() {
      if (used_) used_->fetch_sub(1, std::memory_order_relaxed);
    }
    [[nodiscard]] explicit operator bool() const noexcept { return used_ != nullptr; }

   private:
    friend class Quota;
    explicit Held(std::shared_ptr<std::atomic<std::uint32_t>> used) noexcept : used_{std::move(used)} {}
    std::shared_ptr<std::atomic<std::uint32_t>> used_;
  };

  /// `refusal`: what the error says, a literal. Empty `most`: not limited, but counted.
  Quota(const char* refusal, std::optional<std::uint32_t> most) : refusal_{refusal}, most_{most} {}
  Quota(const Quota&) = delete;
  Quota& operator=(const Quota&) = delete;

  /// ResourceExhausted with the words of the quota and, as its value, how many there may be: all of them are held.
  [[nodiscard]] Result<Held> take() noexcept {
    std::uint32_t used = used_->load(std::memory_order_relaxed);
    do {
      if (most_ && used >= *most_) {
        refused_.fetch_add(1, std::memory_order_relaxed);
        return fail(ErrorCode::ResourceExhausted, refusal_, *most_);
      }
    } while (!used_->compare_exchange_weak(used, used + 1, std::memory_order_relaxed));
    std::uint32_t high = high_.load(std::memory_order_relaxed);
    while (high < used + 1 && !high_.compare_exchange_weak(high, used + 1, std::memory_order_relaxed)) {}
    return Held{used_};
  }

  [[nodiscard]] std::optional<std::uint32_t> most() const noexcept { return most_; }
  [[nodiscard]] std::uint32_t used() const noexcept { return used_->load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint32_t high() const noexcept { return high_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint32_t refused() const noexcept { return refused_.load(std::memory_order_relaxed); }

 private:
  const char* refusal_;
  std::optional<std::uint32_t> most_;
  std::shared_ptr<std::atomic<std::uint32_t>> used_{std::make_shared<std::atomic<std::uint32_t>>(0)};
  std::atomic<std::uint32_t> high_{0};
  std::atomic<std::uint32_t> refused_{0};
};

}  // namespace hirosco
