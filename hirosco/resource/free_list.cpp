// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/resource/free_list.hpp"

#include <new>

namespace hirosco {
namespace {

/// Newton's iteration doubles the right bits each time: 3 -> 6 -> 12 -> 24 -> 48 -> 96.
[[nodiscard]] constexpr std::uint64_t inverse_of_odd(std::uint64_t odd) noexcept {
  std::uint64_t inverse = odd;
  for (int i = 0; i < 5; ++i) inverse *= 2 - odd * inverse;
  return inverse;
}
static_assert(inverse_of_odd(3) * 3 == 1 && inverse_of_odd(0xFFFF'FFFF'FFFF'FFFF) == 0xFFFF'FFFF'FFFF'FFFF);

}  // namespace

BlockRow::BlockRow(MutableOctets memory, std::size_t block_octets, std::uint32_t count) noexcept
    : start_{memory.data()},
      block_octets_{block_octets},
      inverse_{inverse_of_odd(block_octets >> std::countr_zero(block_octets))},
      twos_{std::countr_zero(block_octets)},
      count_{count} {}

void SharedFreeList::build(const BlockRow& row, MutableOctets links) {
  row_ = row;
  next_ = reinterpret_cast<std::atomic<std::uint32_t>*>(links.data());
  for (std::uint32_t i = 0; i < row.count(); ++i)
    ::new (next_ + i) std::atomic<std::uint32_t>{i + 1 == row.count() ? none : i + 1};
  head_.store(head_of(0, row.count() == 0 ? none : 0), std::memory_order_release);
}

void LocalFreeList::build(const BlockRow& row, MutableOctets /*links*/) {
  row_ = row;
  first_ = nullptr;
  for (std::uint32_t i = row.count(); i > 0; --i) first_ = new (row.block(i - 1)) Link{first_};
}

}  // namespace hirosco
