// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>

namespace hirosco {

/// An array whose length the descriptor gives, 1 to N: the same code for an arm of two joints and of seven. It lies in its
/// object whole, N elements and their number; elements beyond the length are zeros. What is published, required or
/// used as a device's has its length from then on, whatever is stored into it: a shorter value is filled up with zeros, a
/// longer one is cut.
/// All of it: Realtime: bounded, no allocation.
template <class T, std::size_t N>
class Sized {
  static_assert(N >= 1 && N <= 0xFFFF, "an array has 1 to 65535 elements");

 public:
  using value_type = T;
  using iterator = T*;
  using const_iterator = const T*;

  /// No element.
  constexpr Sized() noexcept = default;
  /// These elements, at most N of them.
  constexpr Sized(std::initializer_list<T> elements) noexcept : Sized{of({elements.begin(), elements.size()})} {}
  [[nodiscard]] static constexpr Sized of(std::span<const T> elements) noexcept {
    Sized made = zeros(elements.size());
    std::ranges::copy(elements.first(made.size()), made.begin());
    return made;
  }
  [[nodiscard]] static constexpr Sized zeros(std::size_t size) noexcept {
    assert(size <= N);
    Sized made;
    made.size_ = static_cast<std::uint16_t>(std::min(size, N));
    return made;
  }

  [[nodiscard]] constexpr std::size_t size() const noexcept { return size_; }
  [[nodiscard]] constexpr bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] static constexpr std::size_t max_size() noexcept { return N; }

  [[nodiscard]] constexpr T& operator[](std::size_t i) noexcept {
    assert(i < size_);
    return elements_[i];
  }
  [[nodiscard]] constexpr const T& operator[](std::size_t i) const noexcept {
    assert(i < size_);
    return elements_[i];
  }
  [[nodiscard]] constexpr T* data() noexcept { return elements_.data(); }
  [[nodiscard]] constexpr const T* data() const noexcept { return elements_.data(); }
  [[nodiscard]] constexpr iterator begin() noexcept { return data(); }
  [[nodiscard]] constexpr iterator end() noexcept { return data() + size_; }
  [[nodiscard]] constexpr const_iterator begin() const noexcept { return data(); }
  [[nodiscard]] constexpr const_iterator end() const noexcept { return data() + size_; }

  friend constexpr bool operator==(const Sized& a, const Sized& b) noexcept { return std::ranges::equal(a, b); }

  /// Where the length lies behind the first element: for whoever sets it from a descriptor.
  [[nodiscard]] static constexpr std::size_t length_offset() noexcept { return offsetof(Sized, size_); }

 private:
  std::array<T, N> elements_{};
  std::uint16_t size_{0};
};

}  // namespace hirosco
