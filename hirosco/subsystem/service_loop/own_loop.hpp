// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "hirosco/parameter/dictionary.hpp"
#include "hirosco/parameter/write_queue.hpp"
#include "hirosco/pus/service/service_table.hpp"
#include "hirosco/pus/st01_verification/verification.hpp"
#include "hirosco/subsystem/cycle/loop_meter.hpp"
#include "hirosco/subsystem/cycle/queue_fill.hpp"
#include "hirosco/subsystem/pages/pages.hpp"
#include "hirosco/utilities/allocation_guard.hpp"
#include "hirosco/utilities/os/mutex.hpp"
#include "hirosco/utilities/os/semaphore.hpp"
#include "hirosco/utilities/record_ring.hpp"

namespace hirosco {

/// A loop of its own for services of a subsystem (paper 4.1, adr 0096): requests come in by a bounded queue, what its services say
/// goes out by another one to the service loop, which numbers and sends it. Everything that both loops touch besides is ordered
/// by the loop's lock, which the service loop takes where it puts a configuration in force or gives one back, never the cycle.
class OwnLoop final : public pus::ServiceHome, private pus::TelemetrySink {
 public:
  struct Parts {
    const descriptor::ServiceLoop& declared;
    pus::ServiceHome& subsystem;  ///< whose services they are
    const VitalPage& vital;
    const PermitPage& permit;  ///< until take_permit()
    const Clock& clock;
    const Dictionary& dictionary;
    WriteQueue& writes;
    LoopMeter& meter;
    std::size_t place;  ///< among the loops of its subsystem
    std::uint32_t reports_octets{descriptor::Queues{}.loop_reports_octets};
  };
  explicit OwnLoop(const Parts& parts);
  /// Another supervisor's page counts from now on; the one before stays mapped until yet another comes.  Thread: the service loop's.
  void take_permit(const PermitPage& page) noexcept { permit_.store(&page, std::memory_order_release); }

  // --- the subsystem's service loop ----------------------------------------------------------------------------------
  [[nodiscard]] const descriptor::ServiceLoop& declared() const noexcept { return parts_.declared; }
  /// Before the first step.
  void host(pus::Service& service) { services_.add(service); }
  /// A telecommand for one of its services, checked as far as the subsystem checks all of them. False: as many wait as may.
  [[nodiscard]] bool offer(Octets packet, std::uint32_t mode_epoch) noexcept;
  /// Period, priority and budget from now on, those of a configuration or its own; `wanted` outlives the loop. What waits in it stays.
  /// Under its lock. The step that was due is due when it was, or a new period from `now` where that is sooner: the grid goes on from there.
  void follow(const descriptor::ServiceLoop& wanted, TimePoint now) noexcept;
  /// What it said, oldest first, as long as `has_room`: reports by `report`, events by `event`.
  struct Listener {
    std::function<bool()> has_room;
    std::function<void(std::uint8_t service, std::uint8_t subtype, std::uint16_t destination, Octets data)> report;
    std::function<void(std::uint16_t event, Octets auxiliary)> event;
  };
  void tell(const Listener& listener);
  /// The most that has waited on its two ways since this was asked last: requests, octets of what it said.
  struct Fills {
    QueueFill requests, reports;
    QueueFill
        judged{};  ///< requests, as they are warned of; nothing where they are so few that one alone fills much, and none was refused
  };
  [[nodiscard]] Fills take_fills() noexcept;
  /// Looked at after `passed`: it has been in one step for longer than three of its periods and half a second. One that only waits for
  /// the processor to begin a step is in none.
  [[nodiscard]] bool hangs(Duration passed) noexcept;
  /// True once from when it hangs until it moves again.
  [[nodiscard]] bool newly_hangs() noexcept { return !std::exchange(told_, true); }
  [[nodiscard]] Duration stands_for() const noexcept { return stands_for_; }
  /// Reports and events that found no room.  Thread: any.
  [[nodiscard]] std::uint64_t lost() const noexcept { return out_.dropped(); }
  [[nodiscard]] Mutex& mutex() noexcept { return mutex_; }

  // --- the loop --------------------------------------------------------------------------------------------------------
  /// How it goes now.  Realtime: wait-free. Thread: any.
  [[nodiscard]] const descriptor::ServiceLoop& in_force() const noexcept {
    return *in_force_.load(std::memory_order_acquire);
  }
  /// When the step that was due at `planned` is due now.  Realtime: wait-free. Thread: the loop's.
  [[nodiscard]] TimePoint due(TimePoint planned) const noexcept;
  /// True once that step is due. False before: it is due sooner now, the loop goes by another priority, or somebody woke it.
  /// Realtime: blocks. Thread: the loop's.
  [[nodiscard]] bool rest_until(TimePoint planned) noexcept { return !woken_.wait_until(due(planned)); }
  /// Thread: any.
  void wake() noexcept { woken_.post(); }
  /// One step that was due at `planned`, or is sooner now: requests that wait, then each of its services. Returns when the next is due:
  /// on its grid, steps that were missed are skipped.  Thread: the loop's.
  TimePoint step(TimePoint planned);
  /// Of its steps in Safe-Operational and Operational, since it was made; none in programs that do not see them.
  /// Realtime: wait-free. Thread: any.
  [[nodiscard]] AllocationCount heap_uses() const noexcept {
    return {.allocations = allocations_.load(std::memory_order_relaxed),
            .frees = frees_.load(std::memory_order_relaxed)};
  }
  /// It has said what the service loop has not taken yet.  Realtime: wait-free. Thread: any.
  [[nodiscard]] bool has_reports() const noexcept { return out_.used() != 0; }

  // --- of its services -------------------------------------------------------------------------------------------------
  [[nodiscard]] const descriptor::SubsystemDescriptor& descriptor() const noexcept override {
    return parts_.subsystem.descriptor();
  }
  /// Of the vital page; Offline where that was damaged.
  [[nodiscard]] descriptor::State state() const noexcept override;
  [[nodiscard]] bool mode_in_force() const noexcept override;
  [[nodiscard]] pus::Verification& verification() noexcept override { return verification_; }
  [[nodiscard]] pus::TelemetrySink& telemetry() noexcept override { return *this; }
  /// Only ST[17] uses it, which stays in the service loop.
  [[nodiscard]] pus::SelfTest& self_test() noexcept override { return parts_.subsystem.self_test(); }
  [[nodiscard]] pus::FailureNotice refusal(pus::FailureCode code, const Error& why) const override {
    return parts_.subsystem.refusal(code, why);
  }
  [[nodiscard]] Result<> store(const ParameterCell& parameter, Octets big_endian) override;
  [[nodiscard]] Result<> raise(std::string_view event, Octets auxiliary) override;
  [[nodiscard]] bool has_room(std::size_t octets) const noexcept override;

 private:
  void report(std::uint8_t service, std::uint8_t subtype, std::uint16_t destination, Octets source_data) override;
  void handle(Octets record);
  [[nodiscard]] std::optional<descriptor::State> told_state() const noexcept;
  [[nodiscard]] bool commissioned() const noexcept;

  Parts parts_;
  std::atomic<const PermitPage*> permit_;
  std::atomic<const descriptor::ServiceLoop*> in_force_;
  std::atomic<std::int64_t> due_ns_;  ///< of the step that a change made due sooner; the greatest: none was
  Semaphore woken_;
  Mutex mutex_;
  pus::ServiceTable services_;
  RecordRing in_;
  RecordRing out_;
  FillMark in_mark_, out_mark_;  ///< the service loop's
  bool refused_{false};  ///< since take_fills(), the service loop's
  pus::Verification verification_;
  std::uint32_t permitted_by_{0};  ///< the epoch of the mode that the request under way was permitted by; 0: any
  std::atomic<std::uint32_t> waiting_{0};
  std::atomic<std::uint64_t> steps_{0};
  std::atomic<std::uint64_t> allocations_{0}, frees_{0};
  std::atomic<bool> in_step_{false};
  std::uint64_t seen_steps_{0};  ///< by the service loop, like the next
  Duration stands_for_{};
  bool told_{false};
};

/// Holds the locks of all of them, in their order: nothing of their services is under way.
class LoopsAtRest {
 public:
  explicit LoopsAtRest(const std::vector<std::unique_ptr<OwnLoop>>& loops) noexcept;
  ~LoopsAtRest();
  LoopsAtRest(const LoopsAtRest&) = delete;
  LoopsAtRest& operator=(const LoopsAtRest&) = delete;

 private:
  const std::vector<std::unique_ptr<OwnLoop>>& loops_;
};

}  // namespace hirosco
