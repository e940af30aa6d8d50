// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "hirosco/utilities/octets.hpp"

/// What a supervisor has to know to go on for one that died (docs/adr/0093), in memory that somebody else keeps. What it does with that, in which
/// order, and where: supervisor/README.md.
namespace hirosco::supervisor {

/// Two copies, of which the older is written over: whatever is torn by a death, the other one is whole. A copy has a magic word, the
/// version of what it holds, a sequence number, its length and a checksum over all that; what does not fit them is none.
/// Thread: one.
class Journal {
 public:
  /// Of what the parts note: another build's is not read.
  static constexpr std::uint32_t version = 6;

  /// The memory outlives this; half of it is the most that one copy holds, with its head.
  explicit Journal(MutableOctets memory) noexcept : memory_{memory} {}

  /// The newest whole copy. Empty: there is none.
  [[nodiscard]] Octets newest() const noexcept;
  /// False: it is longer than a copy may be, and nothing was written. What was there is looked at before the first time only: nobody else
  /// writes here while this does.  Realtime: bounded, no allocation.
  bool write(Octets content) noexcept;
  /// Neither copy is one any more.  Realtime: bounded, no allocation.
  void clear() noexcept;
  [[nodiscard]] std::size_t most_octets() const noexcept;

 private:
  struct Head;
  [[nodiscard]] MutableOctets copy(std::size_t which) const noexcept;
  /// Its sequence number; 0: it is none.
  [[nodiscard]] std::uint64_t sequence_of(std::size_t which) const noexcept;

  MutableOctets memory_;
  /// Of the newest copy, once this has written or is about to.
  struct Newest {
    std::size_t which{0};
    std::uint64_t sequence{0};
  };
  std::optional<Newest> known_;
};

/// A part that notes what it knows, and is told it again in the next supervisor, before anything else is asked of it.
class Remembered {
 public:
  virtual ~Remembered() = default;
  /// What does not fit is not remembered at all.  Realtime: bounded.
  virtual void note(OctetWriter& writer) const = 0;
  /// What cannot be read `reader` tells; then nothing of the note counts and what moves is stopped, whatever a part has taken of it.
  virtual void recall(OctetReader& reader) = 0;
};

/// Puts the parts' notes together, each with its number and length, and takes them apart again. Thread: one.
class Memory {
 public:
  /// `journal` null: nothing is remembered.
  Memory(Journal* journal, std::vector<Remembered*> parts) : journal_{journal}, parts_{std::move(parts)} {}

  /// Notes what has changed since the last time. False: there is no room for all of it, and nothing is noted any more: what was known
  /// before would be believed, a stop that came since forgotten.
  bool note();
  /// True: there was something, all of it was read, and each part has been told.
  [[nodiscard]] bool recall();

 private:
  [[nodiscard]] bool put_together(OctetWriter& all);

  Journal* journal_;
  std::vector<Remembered*> parts_;
  std::vector<std::byte> buffer_, written_, part_;
};

}  // namespace hirosco::supervisor
