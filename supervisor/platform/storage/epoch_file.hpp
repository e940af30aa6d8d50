// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

/// Remembers beyond the flight which epochs devices may have seen, so that one that outlives the supervisor neither stays
/// latched nor takes an old command for a new one (hazard SF11).
namespace hirosco::supervisor {

/// Thread: the supervisor's.
class EpochFile {
 public:
  explicit EpochFile(std::filesystem::path path);
  /// Epoch that a flight begins with: above all that were kept, and not below the seconds since 2020. Blocks until the disk has it.
  /// OutOfRange: the numbers have run out. A file that cannot be read or written leaves the clock's number.
  [[nodiscard]] Result<std::uint32_t> first(OnboardTime now);
  /// A disk that works has read a file of one line by far before that.
  static constexpr Duration longest_wait = std::chrono::milliseconds{100};
  /// The same for whoever goes on with a flight, also above what supervisors before it have used without a disk that kept it. Waits for no
  /// write, and no longer than `patience` for what the file says: a thread of its own reads, another writes. What was noted suffices.
  /// \param noted The highest in use that they had noted (KeeperPage::epoch_in_use); 0: none, so that nobody flies and the file is waited for.
  [[nodiscard]] Result<std::uint32_t> next(OnboardTime now, std::uint32_t noted, Duration patience = longest_wait);
  /// Reserves further epochs before they are used up, which no ordinary flight comes to. Waits for no disk: a thread of its own writes,
  /// and one that cannot is tried again later.
  void keep_above(std::uint32_t used);
  /// What the disk has.
  [[nodiscard]] std::uint32_t kept() const noexcept;
  [[nodiscard]] const std::filesystem::path& path() const noexcept;

 private:
  struct File;
  [[nodiscard]] Result<std::uint32_t> above(std::uint64_t kept, OnboardTime now, std::uint64_t used = 0) const;
  /// What the file says; 0 where it does not within this time.
  [[nodiscard]] std::uint64_t read_within(Duration patience) const;
  void keep_in_a_thread(std::uint32_t reserved);
  std::shared_ptr<File> file_;  ///< what the disk holds up outlives the flight's own end
  std::uint32_t next_try_{0};
};

}  // namespace hirosco::supervisor
