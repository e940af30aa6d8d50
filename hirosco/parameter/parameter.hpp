// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "hirosco/parameter/detail/sequence_lock.hpp"
#include "hirosco/parameter/native_layout.hpp"
#include "hirosco/utilities/octets.hpp"

namespace hirosco {

/// A parameter without its C++ type: what the dictionary and the services see.
///
/// One writer at a time: the cycle while it runs, else the service loop; whoever starts or joins the cycle's thread
/// orders the two. The writer's thread uses the live value, every other thread a snapshot.
class ParameterCell {
 public:
  ParameterCell(const ParameterCell&) = delete;
  ParameterCell& operator=(const ParameterCell&) = delete;

  [[nodiscard]] std::span<const NativeField> fields() const noexcept { return fields_.all(); }
  /// Gives a Sized field its length.  Thread: the service loop's, before a cycle runs.
  void set_length(std::size_t field, std::uint32_t count) noexcept {
    if (fields_.set_length(field, count, live_)) commit();
  }
  [[nodiscard]] bool is_struct() const noexcept { return is_struct_; }
  /// Octets in memory, with padding.
  [[nodiscard]] std::size_t octets() const noexcept { return live_.size(); }

  /// The writer's own value in native form.  Realtime: wait-free. Thread: the writer's.
  [[nodiscard]] Octets live() const noexcept { return live_; }

  /// Sets the whole native value; false (and nothing set) when the size is not octets().
  /// Realtime: wait-free. Thread: the writer's.
  bool write_native(Octets native) noexcept {
    if (native.size() != live_.size()) return false;
    stage(0, native);
    fit();
    commit();
    return true;
  }

  /// Changes part of the live value; other threads see it after commit().  Realtime: wait-free. Thread: the writer's.
  void stage(std::size_t offset, Octets native) noexcept {
    if (offset > live_.size() || native.size() > live_.size() - offset) return;
    std::memcpy(live_.data() + offset, native.data(), native.size());
  }
  /// Shows the live value to the other threads.  Realtime: wait-free. Thread: the writer's.
  void commit() noexcept { parameter_detail::publish(*sequence_, words_, live_.data(), live_.size()); }

  /// How often a value was shown: who has written in between, and whether, is seen from it.  Realtime: wait-free.
  /// Thread: any.
  [[nodiscard]] std::uint64_t stores() const noexcept { return sequence_->load(std::memory_order_relaxed) / 2; }

  /// Copies a whole value as last committed. False when the size is not octets(), or when the writer was in the way
  /// max_attempts times: it never waits for a writer.  Realtime: bounded. Thread: any.
  [[nodiscard]] bool snapshot(MutableOctets native) const noexcept;

  /// Writes `fields` (of this cell) of the live value in big-endian order without padding. Returns the octets written,
  /// 0 when `out` is too small.  Realtime: wait-free. Thread: the writer's.
  [[nodiscard]] std::size_t encode(std::span<const NativeField> fields, MutableOctets out) const noexcept;
  /// The same of a whole committed value; 0 also when it was not whole after max_attempts.
  /// Realtime: bounded. Thread: any.
  [[nodiscard]] std::size_t snapshot_encode(std::span<const NativeField> fields, MutableOctets out) const noexcept;

  /// Stages `fields` from big-endian octets without padding; false (and nothing staged) when the length differs.
  /// Realtime: wait-free. Thread: the writer's.
  bool stage_encoded(std::span<const NativeField> fields, Octets encoded) noexcept;

  /// Attempts of a snapshot. A writer that is never preempted for long by its readers needs a handful.
  static constexpr int max_attempts = 256;

 protected:
  using Word = parameter_detail::Word;
  ParameterCell(ObjectFields fields, bool is_struct, MutableOctets live, std::atomic<Word>* sequence,
                std::atomic<Word>* words) noexcept
      : fields_{fields}, live_{live}, sequence_{sequence}, words_{words}, is_struct_{is_struct} {}
  ~ParameterCell() = default;
  void fit() noexcept { fields_.fit(live_); }

 private:
  ObjectFields fields_;
  MutableOctets live_;
  std::atomic<Word>* sequence_;
  std::atomic<Word>* words_;
  bool is_struct_;
};

/// Octets of fields on the wire: packed.
[[nodiscard]] constexpr std::size_t encoded_octets(std::span<const NativeField> fields) noexcept {
  std::size_t sum = 0;
  for (const auto& field : fields) sum += field.octets();
  return sum;
}

/// A typed parameter, a member variable of the subsystem that owns it.
template <class T>
class Parameter final : private HasFields<T>, public ParameterCell {
  static constexpr std::size_t word_count = parameter_detail::words_for(sizeof(T));

 public:
  using Value = T;

  Parameter() noexcept : Parameter(T{}) {}
  explicit Parameter(const T& initial) noexcept
      : ParameterCell{HasFields<T>::fields(), ParameterStructure<T>, std::as_writable_bytes(std::span{&value_, 1}),
                      &sequence_, words_},
        value_{initial} {
    show();
  }

  /// Realtime: wait-free. Thread: the writer's.
  [[nodiscard]] T load() const noexcept { return value_; }
  /// Realtime: wait-free. Thread: the writer's.
  void store(const T& value) noexcept {
    value_ = value;
    if constexpr (HasFields<T>::sized) ParameterCell::fit();
    show();
  }
  /// The typed snapshot for other threads; false as ParameterCell::snapshot.  Realtime: bounded. Thread: any.
  [[nodiscard]] bool snapshot(T& value) const noexcept {
    return ParameterCell::snapshot(std::as_writable_bytes(std::span{&value, 1}));
  }
  using ParameterCell::fields;
  using ParameterCell::snapshot;

 private:
  void show() noexcept {
    parameter_detail::publish(sequence_, words_, reinterpret_cast<const std::byte*>(&value_), sizeof(T));
  }

  T value_{};
  alignas(64) std::atomic<Word> sequence_{0};  // the sequence shares a cache line with the first seven words
  std::atomic<Word> words_[word_count]{};  // no std::array: the base takes its address before it is constructed
};

}  // namespace hirosco
