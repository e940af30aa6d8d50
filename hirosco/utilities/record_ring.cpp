// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/record_ring.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace hirosco {
namespace {

[[nodiscard]] constexpr std::uint64_t filled_up(std::uint64_t octets) noexcept {
  return (octets + 7) & ~std::uint64_t{7};
}

}  // namespace

RecordRing::RecordRing(std::size_t octets)
    : mask_{std::bit_ceil(std::max<std::size_t>(octets, 64)) - 1}, buffer_{std::make_unique<std::byte[]>(mask_ + 1)} {}

bool RecordRing::has_room(std::uint64_t end) noexcept {
  if (end - producer_.other <= capacity()) return true;
  producer_.other = consumer_.position.load(std::memory_order_acquire);
  return end - producer_.other <= capacity();
}

bool RecordRing::reserve(std::size_t octets) noexcept {
  reserved_ = false;
  const std::uint64_t head = producer_.position.load(std::memory_order_relaxed);
  const std::uint64_t need = header_octets + filled_up(std::min(octets, capacity()));
  const std::uint64_t before_end = capacity() - (head & mask_);
  const std::uint64_t start = need <= before_end ? head : head + before_end;
  if (octets > max_record() || !has_room(start + need)) {
    dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    return false;
  }
  // Not published before the record is: until then a shorter reservation may overwrite the mark.
  if (start != head) put_length(head, skip_mark);
  reserved_at_ = start;
  reserved_octets_ = octets;
  reserved_ = true;
  return true;
}

void RecordRing::publish(std::size_t used) noexcept {
  put_length(reserved_at_, static_cast<std::uint32_t>(used));
  reserved_ = false;
  producer_.position.store(reserved_at_ + header_octets + filled_up(used), std::memory_order_release);
}

bool RecordRing::try_write(Octets a, Octets b) noexcept {
  const std::size_t octets = a.size() > capacity() ? a.size() : a.size() + b.size();
  if (!reserve(octets)) return false;
  std::byte* place = at(reserved_at_ + header_octets);
  if (!a.empty()) std::memcpy(place, a.data(), a.size());
  if (!b.empty()) std::memcpy(place + a.size(), b.data(), b.size());
  publish(octets);
  return true;
}

MutableOctets RecordRing::try_reserve(std::size_t octets) noexcept {
  if (octets == 0 || !reserve(octets)) return {};
  return {at(reserved_at_ + header_octets), octets};
}

void RecordRing::commit(std::size_t used) noexcept {
  if (reserved_) publish(std::min(used, reserved_octets_));
}

std::optional<Octets> RecordRing::front() noexcept {
  std::uint64_t tail = consumer_.position.load(std::memory_order_relaxed);
  if (tail == consumer_.other) {
    consumer_.other = producer_.position.load(std::memory_order_acquire);
    if (tail == consumer_.other) return std::nullopt;
  }
  // A mark is published together with the record after it, so what follows it is there.
  if (length_at(tail) == skip_mark) {
    tail += capacity() - (tail & mask_);
    consumer_.position.store(tail, std::memory_order_release);
  }
  return Octets{at(tail + header_octets), length_at(tail)};
}

void RecordRing::pop() noexcept {
  const std::optional<Octets> record = front();
  if (!record) return;
  const std::uint64_t tail = consumer_.position.load(std::memory_order_relaxed);
  consumer_.position.store(tail + header_octets + filled_up(record->size()), std::memory_order_release);
}

std::size_t RecordRing::used() const noexcept {
  const std::uint64_t tail = consumer_.position.load(std::memory_order_acquire);
  const std::uint64_t head = producer_.position.load(std::memory_order_acquire);
  return static_cast<std::size_t>(std::min<std::uint64_t>(head - tail, capacity()));
}

void RecordRing::put_length(std::uint64_t position, std::uint32_t length) noexcept {
  std::memcpy(at(position), &length, sizeof length);
}

std::uint32_t RecordRing::length_at(std::uint64_t position) noexcept {
  std::uint32_t length{};
  std::memcpy(&length, at(position), sizeof length);
  return length;
}

}  // namespace hirosco
