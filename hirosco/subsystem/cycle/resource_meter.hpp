// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/resource/pool_resource.hpp"
#include "hirosco/resource/quota.hpp"
#include "hirosco/subsystem/cycle/queue_fill.hpp"
#include "hirosco/utilities/os/process_usage.hpp"
#include "hirosco/utilities/processor_share.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// What a subsystem has taken, as a parameter of every subsystem: RESOURCE_STATS (descriptor/model/framework_parameters.hpp).
struct ResourceStatistics {
  std::uint32_t memory_kb{
      0};  ///< 0 where nobody can tell, like the next five: in simulation, and of threads of one process
  std::uint32_t memory_high_kb{0};  ///< most that was seen, ten times in a second
  std::uint32_t descriptors{0};
  std::uint32_t descriptors_high{0};
  std::uint32_t threads{0};
  std::uint32_t threads_high{0};
  std::array<std::uint32_t, descriptor::most_pools> pool_used{};  ///< blocks, by ascending size; Offline has none
  std::array<std::uint32_t, descriptor::most_pools> pool_high{};  ///< most ever
  std::uint32_t pool_refused{0};  ///< requests for which there was no block
  std::uint16_t ports{0};  ///< acquired by the framework for devices and links, and by the author
  std::uint16_t ports_high{0};
  std::uint16_t files{0};  ///< acquired by the author
  std::uint16_t files_high{0};
  std::uint16_t held_refused{0};  ///< requests for a port or file beyond what the descriptor permits
  /// A structure has 16 members at most: these are four more of this one.
  struct Process {
    std::uint64_t shared_memory_kb{0};  ///< in RAM; 0 where nobody can tell, like the next three
    std::uint64_t shared_memory_high_kb{0};  ///< most that was seen, ten times in a second
    std::uint16_t processor_percent{0};  ///< of one processor, over the second that has ended
    std::uint16_t processor_high_percent{0};
  } process{};
  /// Messages for the supervisor: answers, events, housekeeping; the most at once in the last tenth of a second, and ever.
  struct Waiting {
    std::array<std::uint16_t, 3> now{};
    std::array<std::uint16_t, 3> high{};
    /// Of what each holds, in percent, by Resource from CycleCommands on: likewise.
    std::array<std::uint8_t, descriptor::queues_of_subsystem> queues{};
    std::array<std::uint8_t, descriptor::queues_of_subsystem> queues_high{};
    /// On which its cycle is (docs/adr/0234); behind all others, so that who knows nothing of it reads the rest. 65535: on none alone, or
    /// nobody can tell.
    std::uint16_t core{ProcessUsage::no_core};
  } waiting{};
};

/// The resources of one subsystem: its pools, how much it has taken, and where that crosses the warning level of its descriptor.
/// The pools are there from Software-Init to Software-Deinit; Offline has none (docs/adr/0215).
class ResourceMeter {
 public:
  static constexpr Duration look_every = std::chrono::milliseconds{100};

  explicit ResourceMeter(const descriptor::Resources& declared);
  ResourceMeter(const ResourceMeter&) = delete;
  ResourceMeter& operator=(const ResourceMeter&) = delete;

  /// Takes the pools of the descriptor; those that are still there, with the blocks that are still held, where they could not be given back.
  /// ResourceExhausted, with how many octets: there is no such memory, and there are no pools. Words of this and the next live until the next call.
  /// Thread: service loop; the cycle rests.
  [[nodiscard]] Result<> take_pools();
  /// Gives their memory back to the system. Mismatch, with how many: blocks are held still, so it stays, nothing is given of it any more,
  /// and it goes when this is asked once more and they have come back; so too, without an error, where a thread is just giving back one.
  /// Thread: service loop; the cycle rests.
  [[nodiscard]] Result<> give_pools_back();
  /// What the author takes from: for as long as this lives, whether there are pools or not.
  [[nodiscard]] PoolResource& pools() noexcept { return *resource_; }
  /// What whoever holds blocks still has to outlive, when this ends, with what he had `before`; null: nobody holds any.
  [[nodiscard]] std::shared_ptr<const void> leave_pools_behind(std::shared_ptr<const void> before);
  /// Of ports and files: who opens one takes it here before.
  [[nodiscard]] Quota& ports() noexcept { return ports_; }
  [[nodiscard]] Quota& files() noexcept { return files_; }

  /// Use that has reached the warning level from below since it was told last.
  struct Crossing {
    descriptor::Resource resource{};
    std::uint32_t block_octets{0};  ///< of a pool
    std::uint32_t used{0};  ///< now: it may be less again
    std::uint32_t limit{0};
    std::uint32_t times{0};
  };
  /// What was seen of the process. Processor time is judged by the second.  Thread: service loop.
  void note(const ProcessUsage& usage, TimePoint now) noexcept;
  /// How many ports and files are held now.  Thread: service loop.
  void note_held() noexcept;
  /// How many messages have waited at once since this was said last.  Thread: service loop.
  void note_waiting(const descriptor::Waiting& most) noexcept;
  /// How full its queues have been since this was said last.  Thread: service loop.
  /// \param judged What of it is warned of; a place without room: nothing.
  void note_queues(const QueueFills& fills, const QueueFills& judged) noexcept;
  /// Tells each crossing once.  Realtime: bounded. Thread: service loop.
  void tell_crossings(const std::function<void(const Crossing&)>& tell);

  /// Realtime: wait-free. Thread: any that runs while pools neither come nor go: the cycle.
  [[nodiscard]] ResourceStatistics statistics() const noexcept;

 private:
  /// Of the process: newest, highest, and whether it stands above the level.
  struct Seen {
    std::atomic<std::uint32_t> now{0};
    std::atomic<std::uint32_t> high{0};
    bool above{false};
    std::uint32_t crossings{0};
  };
  void note(descriptor::Resource resource, std::uint32_t amount) noexcept;
  [[nodiscard]] std::optional<std::uint32_t> limit_of(descriptor::Resource resource) const noexcept;

  const descriptor::Resources& declared_;
  std::array<Seen, descriptor::counted_resources> seen_;
  ProcessorShare processor_;
  std::atomic<std::uint16_t> core_{ProcessUsage::no_core};
  std::array<std::atomic<std::uint32_t>, descriptor::most_pools> pool_crossings_{};  ///< by who allocates
  Quota ports_, files_;
  std::unique_ptr<BlockPools> pools_;
  std::unique_ptr<PoolResource> resource_{std::make_unique<PoolResource>()};
  // Of pools that were given back.
  std::array<std::uint32_t, descriptor::most_pools> pool_high_before_{};
  std::uint64_t pool_refused_before_{0};
  std::array<std::uint32_t, descriptor::queues_of_subsystem> queue_rooms_{};  ///< the service loop's
  std::array<std::atomic<std::uint8_t>, descriptor::queues_of_subsystem> queues_{}, queues_high_{};  ///< percent
  std::string words_;  ///< of an error, which does not own them
};

}  // namespace hirosco
