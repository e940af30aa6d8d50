// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"
#include "supervisor/platform/storage/value_copies.hpp"
#include "supervisor/platform/storage/value_disk.hpp"

namespace hirosco::supervisor {

/// What became of values that were to be kept.
struct KeptOutcome {
  std::string subsystem;
  std::uint64_t sequence{};
  std::optional<Error> failure{};  ///< empty: both copies are on the disk
};

/// Seam: keeps the persistent values of subsystems beyond the flight, a pair of copies each, by the subsystem's name.
class ValueStore {
 public:
  virtual ~ValueStore() = default;
  /// Before the first keep() of this subsystem.  Realtime: blocks. Thread: the supervisor's.
  [[nodiscard]] virtual TwoCopies read(std::string_view subsystem) = 0;
  /// Of several that wait for one subsystem the newest is written.  Realtime: never waits for a disk. Thread: the supervisor's.
  virtual void keep(std::string_view subsystem, ValueCopy copy) = 0;
  /// Since it was asked last. What failed is not tried again by itself.  Realtime: never waits for a disk. Thread: the supervisor's.
  [[nodiscard]] virtual std::vector<KeptOutcome> take_outcomes() = 0;
};

/// Writes before keep() returns: simulation and tests.
class DirectValueStore final : public ValueStore {
 public:
  /// `disk` must outlive this.
  DirectValueStore(ValueDisk& disk, std::filesystem::path folder) : disk_{disk}, folder_{std::move(folder)} {}
  TwoCopies read(std::string_view subsystem) override { return copies_of(subsystem).read(); }
  void keep(std::string_view subsystem, ValueCopy copy) override;
  std::vector<KeptOutcome> take_outcomes() override { return std::exchange(outcomes_, {}); }

 private:
  [[nodiscard]] ValueCopies& copies_of(std::string_view subsystem);

  ValueDisk& disk_;
  std::filesystem::path folder_;
  std::map<std::string, ValueCopies, std::less<>> copies_;
  std::vector<KeptOutcome> outcomes_;
};

/// Writes in a thread of its own, of ordinary priority: a disk that hangs holds nobody up. Bounded: one that waits for each subsystem.
class ThreadedValueStore final : public ValueStore {
 public:
  /// How long its end waits for what is still to be written; then the thread is left to the disk.
  static constexpr Duration last_wait = std::chrono::seconds{2};

  /// `clock` is the real monotonic one and must outlive this.
  ThreadedValueStore(const Clock& clock, std::unique_ptr<ValueDisk> disk, const std::filesystem::path& folder);
  ~ThreadedValueStore() override;
  ThreadedValueStore(const ThreadedValueStore&) = delete;
  ThreadedValueStore& operator=(const ThreadedValueStore&) = delete;
  TwoCopies read(std::string_view subsystem) override;
  void keep(std::string_view subsystem, ValueCopy copy) override;
  std::vector<KeptOutcome> take_outcomes() override;

 private:
  struct Work;
  const Clock& clock_;
  std::shared_ptr<Work> work_;  ///< shared with its thread, which may outlive this
};

}  // namespace hirosco::supervisor
