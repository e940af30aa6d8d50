// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "hirosco/resource/block_pools.hpp"

namespace hirosco {

template <class T>
class Counted;
template <class T, class Pools, class... Args>
[[nodiscard]] Result<Counted<T>> make_counted(Pools& pools, Args&&... args);

namespace detail {

/// A PoolResource says the same two things by other words, as its own allocate() throws.
template <class Pools>
[[nodiscard]] void* block_of(Pools& pools, std::size_t octets, std::size_t alignment) noexcept {
  if constexpr (requires { pools.try_allocate(octets, alignment); }) return pools.try_allocate(octets, alignment);
  else return pools.allocate(octets, alignment);
}
template <class Pools>
void take_block_back(Pools& pools, void* block) noexcept {
  if constexpr (requires { pools.give_back(block); }) static_cast<void>(pools.give_back(block));
  else static_cast<void>(pools.deallocate(block));
}

/// Stands before the object in its block.
struct CountedBlock {
  std::atomic<std::uint32_t> owners{1};
  void* pools{nullptr};
  /// Destroys the object and gives the block back: knows both types.
  void (*destroy)(CountedBlock*) noexcept {nullptr};
};

template <class T>
struct CountedObject : CountedBlock {
  template <class... Args>
  explicit CountedObject(Args&&... args) : object(std::forward<Args>(args)...) {}
  T object;
};

}  // namespace detail

/// Shares one object of pools between owners; the last one destroys it (paper 4.1: counted pointer). May be empty.
/// Realtime: wait-free, but the last owner pays for the destructor. Thread: one pointer one thread, the object's owners
/// may be in different ones (not on LocalBlockPools).
template <class T>
class Counted {
 public:
  Counted() = default;
  Counted(std::nullptr_t) noexcept {}
  Counted(const Counted& other) noexcept : Counted{other.object_, other.block_} { add_owner(); }
  Counted(Counted&& other) noexcept
      : Counted{std::exchange(other.object_, nullptr), std::exchange(other.block_, nullptr)} {}
  /// To a base class or to const.
  template <class U>
    requires std::convertible_to<U*, T*>
  Counted(Counted<U> other) noexcept
      : Counted{std::exchange(other.object_, nullptr), std::exchange(other.block_, nullptr)} {}
  Counted& operator=(Counted other) noexcept {
    std::swap(object_, other.object_);
    std::swap(block_, other.block_);
    return *this;
  }
  ~Counted() {
    // The last owner sees all that the others did to the object.
    if (block_ != nullptr && block_->owners.fetch_sub(1, std::memory_order_acq_rel) == 1) block_->destroy(block_);
  }

  [[nodiscard]] T* get() const noexcept { return object_; }
  [[nodiscard]] T& operator*() const noexcept { return *object_; }
  [[nodiscard]] T* operator->() const noexcept { return object_; }
  explicit operator bool() const noexcept { return object_ != nullptr; }
  /// A moment's view; 0 when empty.
  [[nodiscard]] std::uint32_t owners() const noexcept {
    return block_ == nullptr ? 0 : block_->owners.load(std::memory_order_relaxed);
  }
  void reset() noexcept { *this = Counted{}; }
  friend bool operator==(const Counted& a, const Counted& b) noexcept { return a.object_ == b.object_; }
  friend bool operator==(const Counted& a, std::nullptr_t) noexcept { return a.object_ == nullptr; }

 private:
  template <class U>
  friend class Counted;
  template <class U, class Pools, class... Args>
  friend Result<Counted<U>> make_counted(Pools& pools, Args&&... args);

  Counted(T* object, detail::CountedBlock* block) noexcept : object_{object}, block_{block} {}
  void add_owner() const noexcept {
    if (block_ != nullptr) block_->owners.fetch_add(1, std::memory_order_relaxed);
  }

  T* object_{nullptr};
  detail::CountedBlock* block_{nullptr};
};

/// Makes an object in a block of pools or of a PoolResource; ResourceExhausted when they refuse. What its constructor throws goes through.
template <class T, class Pools, class... Args>
Result<Counted<T>> make_counted(Pools& pools, Args&&... args) {
  using Object = detail::CountedObject<T>;
  constexpr std::size_t alignment = alignof(Object) > block_alignment ? alignof(Object) : block_alignment;
  static_assert(alignment <= max_block_alignment);
  void* const place = detail::block_of(pools, sizeof(Object), alignment);
  if (place == nullptr) return fail(ErrorCode::ResourceExhausted, "no free block in the pools", sizeof(Object));
  Object* made = nullptr;
  try {
    made = new (place) Object(std::forward<Args>(args)...);
  } catch (...) {
    detail::take_block_back(pools, place);
    throw;
  }
  made->pools = &pools;
  made->destroy = [](detail::CountedBlock* block) noexcept {
    auto* const home = static_cast<Pools*>(block->pools);
    auto* const object = static_cast<Object*>(block);
    object->~Object();
    detail::take_block_back(*home, object);
  };
  return Counted<T>{&made->object, made};
}

}  // namespace hirosco
