// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/resource_meter.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "hirosco/utilities/sanitizer.hpp"

namespace hirosco {

using descriptor::Resource;

ResourceMeter::ResourceMeter(const descriptor::Resources& declared)
    : declared_{declared},
      ports_{"all ports that its descriptor permits are held", amount_of(declared.most, Resource::Ports)},
      files_{"all files that its descriptor permits are held", amount_of(declared.most, Resource::Files)} {}

Result<> ResourceMeter::take_pools() {
  if (declared_.pools.empty()) return ok();
  if (pools_ != nullptr) {
    resource_->open(*pools_);
    return ok();
  }
  static_assert(descriptor::octets_of(descriptor::Pool{0, 1}) == SharedFreeList::link_octets);
  std::vector<PoolSpec> specs;
  for (const descriptor::Pool& pool : declared_.pools) specs.push_back({pool.block_octets, pool.blocks});
  PoolNotices notices;
  notices.warning_percent = declared_.warning_percent;
  // Possibly in the cycle: it is only counted here.
  notices.on_warning = [this](std::size_t pool, const PoolUsage&) {
    pool_crossings_[pool].fetch_add(1, std::memory_order_relaxed);
  };
  auto made = BlockPools::create(specs, std::move(notices));
  if (!made) {
    words_ = "its pools: " + std::string{made.error().text} + " (" + std::to_string(made.error().value) + ")";
    return fail(made.error().code, words_.c_str(), made.error().value);
  }
  pools_ = std::move(*made);
  resource_->open(*pools_);
  return ok();
}

Result<> ResourceMeter::give_pools_back() {
  if (pools_ == nullptr) return ok();
  resource_->close();
  if (!resource_->let_go()) {
    words_.clear();
    std::uint32_t held = 0;
    for (std::size_t i = 0; i < pools_->size(); ++i) {
      const PoolUsage usage = pools_->usage(i);
      if (usage.used == 0) continue;
      held += usage.used;
      words_ += (words_.empty() ? "blocks still held: " : ", ") + std::to_string(usage.used) + " of " +
                std::to_string(usage.block_octets) + " octets";
    }
    if (held == 0) return ok();
    return fail(ErrorCode::Mismatch, words_.c_str(), held);
  }
  for (std::size_t i = 0; i < pools_->size(); ++i)
    pool_high_before_[i] = std::max(pool_high_before_[i], pools_->usage(i).high_water);
  pool_refused_before_ += pools_->refused();
  pools_.reset();
  return ok();
}

std::shared_ptr<const void> ResourceMeter::leave_pools_behind(std::shared_ptr<const void> before) {
  if (give_pools_back() && pools_ == nullptr) return before;
  struct Left {
    std::shared_ptr<const void> before;
    std::unique_ptr<BlockPools> pools;
    std::unique_ptr<PoolResource> resource;
  };
  return std::make_shared<Left>(Left{std::move(before), std::move(pools_), std::move(resource_)});
}

void ResourceMeter::note(const ProcessUsage& usage, TimePoint now) noexcept {
  note(Resource::Memory, usage.memory_kb);
  note(Resource::SharedMemory, usage.shared_memory_kb);
  note(Resource::Threads, usage.threads);
  note(Resource::Descriptors, usage.descriptors);
  core_.store(usage.cycle_core, std::memory_order_relaxed);
  if (const auto percent = processor_.look(usage.processor, now)) note(Resource::Processor, *percent);
}

void ResourceMeter::note_held() noexcept {
  note(Resource::Ports, ports_.used());
  note(Resource::Files, files_.used());
}

void ResourceMeter::note_waiting(const descriptor::Waiting& most) noexcept {
  for (std::size_t i = 0; i < most.size(); ++i)
    note(static_cast<Resource>(static_cast<std::size_t>(Resource::WaitingAnswers) + i), most[i]);
}

void ResourceMeter::note_queues(const QueueFills& fills, const QueueFills& judged) noexcept {
  for (std::size_t i = 0; i < fills.size(); ++i) {
    if (fills[i].room == 0) continue;
    if (judged[i].room != 0) queue_rooms_[i] = judged[i].room;
    note(static_cast<Resource>(static_cast<std::size_t>(Resource::CycleCommands) + i), judged[i].most);
    const std::uint8_t percent = fills[i].percent();
    queues_[i].store(percent, std::memory_order_relaxed);
    if (percent > queues_high_[i].load(std::memory_order_relaxed))
      queues_high_[i].store(percent, std::memory_order_relaxed);
  }
}

std::optional<std::uint32_t> ResourceMeter::limit_of(Resource resource) const noexcept {
  if (built_with_sanitizer && resource == Resource::Memory) return std::nullopt;
  if (resource < Resource::WaitingAnswers) return amount_of(declared_.most, resource);
  if (resource > Resource::Channel) return std::nullopt;  // the supervisor's alone
  if (resource >= Resource::CycleCommands) return queue_rooms_[place_of(resource)];
  return declared_.waiting[static_cast<std::size_t>(resource) - static_cast<std::size_t>(Resource::WaitingAnswers)];
}

void ResourceMeter::note(Resource resource, std::uint32_t amount) noexcept {
  Seen& seen = seen_[static_cast<std::size_t>(resource)];
  seen.now.store(amount, std::memory_order_relaxed);
  if (amount > seen.high.load(std::memory_order_relaxed)) seen.high.store(amount, std::memory_order_relaxed);
  const auto most = limit_of(resource);
  if (!most || amount == 0) {
    seen.above = false;
    return;
  }
  constexpr std::uint64_t whole = 100;
  const bool above = amount * whole >= std::uint64_t{*most} * declared_.warning_percent;
  if (above && !seen.above) ++seen.crossings;
  seen.above = above;
}

void ResourceMeter::tell_crossings(const std::function<void(const Crossing&)>& tell) {
  for (std::size_t i = 0; i < seen_.size(); ++i)
    if (const auto times = std::exchange(seen_[i].crossings, 0); times != 0)
      tell({.resource = static_cast<Resource>(i),
            .used = seen_[i].now.load(std::memory_order_relaxed),
            .limit = limit_of(static_cast<Resource>(i)).value_or(0),
            .times = times});
  for (std::size_t i = 0; i < declared_.pools.size(); ++i) {
    const auto times = pool_crossings_[i].exchange(0, std::memory_order_relaxed);
    if (times == 0) continue;
    // Also of pools that have gone since.
    const descriptor::Pool& pool = declared_.pools[i];
    const PoolUsage usage =
        pools_ != nullptr ? pools_->usage(i) : PoolUsage{.block_octets = pool.block_octets, .count = pool.blocks};
    tell({.resource = Resource::Pool,
          .block_octets = static_cast<std::uint32_t>(usage.block_octets),
          .used = usage.used,
          .limit = usage.count,
          .times = times});
  }
}

ResourceStatistics ResourceMeter::statistics() const noexcept {
  const auto of = [this](Resource resource) -> const Seen& { return seen_[static_cast<std::size_t>(resource)]; };
  const auto now = [&](Resource resource) { return of(resource).now.load(std::memory_order_relaxed); };
  const auto high = [&](Resource resource) { return of(resource).high.load(std::memory_order_relaxed); };
  ResourceStatistics all{now(Resource::Memory),       high(Resource::Memory), now(Resource::Descriptors),
                         high(Resource::Descriptors), now(Resource::Threads), high(Resource::Threads)};
  const auto small = [](std::uint32_t count) {
    return static_cast<std::uint16_t>(std::min<std::uint32_t>(count, std::numeric_limits<std::uint16_t>::max()));
  };
  all.ports = small(ports_.used());
  all.ports_high = small(ports_.high());
  all.files = small(files_.used());
  all.files_high = small(files_.high());
  all.held_refused = small(ports_.refused() + files_.refused());
  all.process = {now(Resource::SharedMemory), high(Resource::SharedMemory), small(now(Resource::Processor)),
                 small(high(Resource::Processor))};
  for (std::size_t i = 0; i < all.waiting.now.size(); ++i) {
    const auto resource = static_cast<Resource>(static_cast<std::size_t>(Resource::WaitingAnswers) + i);
    all.waiting.now[i] = small(now(resource));
    all.waiting.high[i] = small(high(resource));
  }
  for (std::size_t i = 0; i < queues_.size(); ++i) {
    all.waiting.queues[i] = queues_[i].load(std::memory_order_relaxed);
    all.waiting.queues_high[i] = queues_high_[i].load(std::memory_order_relaxed);
  }
  all.waiting.core = core_.load(std::memory_order_relaxed);
  all.pool_high = pool_high_before_;
  std::uint64_t refused = pool_refused_before_;
  for (std::size_t i = 0; pools_ != nullptr && i < pools_->size(); ++i) {
    const PoolUsage usage = pools_->usage(i);
    all.pool_used[i] = usage.used;
    all.pool_high[i] = std::max(all.pool_high[i], usage.high_water);
  }
  if (pools_ != nullptr) refused += pools_->refused();
  all.pool_refused = static_cast<std::uint32_t>(refused);
  return all;
}

}  // namespace hirosco
