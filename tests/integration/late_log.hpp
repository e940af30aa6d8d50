// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <utility>

#include "supervisor/platform/storage/packet_log.hpp"

namespace hirosco::testing {

/// A log on virtual time whose records are on the disk a while after they were given, as on a real one: what waits for that leaves in a
/// later step than the one in which it came.
class LateLog final : public supervisor::PacketLog {
 public:
  LateLog(const Clock& clock, Duration late)
      : clock_{clock}, late_{late}, log_{clock, std::make_unique<supervisor::MemoryDatabase>()} {}

 private:
  std::uint64_t do_append(const supervisor::LogEntry& entry) override {
    const TimePoint now = clock_.now();
    while (given_.size() > 1 && given_[1].first <= now) given_.pop_front();
    const std::uint64_t number = log_.append(entry);
    if (number != 0) given_.emplace_back(now + late_, number);
    return number;
  }
  [[nodiscard]] std::uint64_t do_durable() const noexcept override {
    std::uint64_t durable = 0;
    for (const auto& [at, number] : given_) {
      if (at > clock_.now()) break;
      durable = number;
    }
    return durable;
  }
  void do_switch_to(std::unique_ptr<supervisor::Database> next) override { log_.switch_to(std::move(next)); }
  [[nodiscard]] supervisor::LogCounters do_counters() const override { return log_.counters(); }
  [[nodiscard]] std::optional<Error> do_failure() const override { return log_.failure(); }
  [[nodiscard]] supervisor::StoreTrouble do_trouble() const override { return log_.trouble(); }
  [[nodiscard]] OnboardTime do_run() const noexcept override { return log_.run(); }

  const Clock& clock_;
  Duration late_;
  supervisor::DirectPacketLog log_;
  std::deque<std::pair<TimePoint, std::uint64_t>>
      given_;  ///< and when it is on the disk; the newest that is and all that are not
};

}  // namespace hirosco::testing
