// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/resource/block_pools.hpp"

#include <algorithm>

namespace hirosco::detail {

Result<PoolPlan> plan_pools(std::span<const PoolSpec> specs, unsigned warning_percent, std::size_t link_octets) {
  constexpr std::size_t limit = std::size_t{1} << 40;  // octets; keeps every product below in range
  if (specs.empty() || specs.size() > max_pools)
    return fail(ErrorCode::InvalidArgument, "number of pools", static_cast<std::int64_t>(specs.size()));
  if (warning_percent > 100) return fail(ErrorCode::OutOfRange, "warning level in percent", warning_percent);
  PoolPlan plan;
  for (const PoolSpec& spec : specs) {
    if (spec.block_octets == 0 || spec.block_octets > limit)
      return fail(ErrorCode::InvalidArgument, "octets of a pool's blocks",
                  static_cast<std::int64_t>(spec.block_octets));
    const std::size_t octets = rounded_up(spec.block_octets, block_alignment);
    if (spec.count == 0 || spec.count > std::min(max_blocks_of_pool, limit / octets))
      return fail(ErrorCode::InvalidArgument, "count of a pool's blocks", static_cast<std::int64_t>(spec.count));
    plan.pools.push_back({octets, spec.count});
    plan.octets += rounded_up(octets * spec.count, max_block_alignment);
    plan.arena_octets += link_octets * spec.count;
  }
  plan.arena_octets += plan.octets;
  std::ranges::sort(plan.pools, {}, &PoolSpec::block_octets);
  const auto twice = std::ranges::adjacent_find(plan.pools, {}, &PoolSpec::block_octets);
  if (twice != plan.pools.end())
    return fail(ErrorCode::AlreadyExists, "two pools of one block size",
                static_cast<std::int64_t>(twice->block_octets));
  return plan;
}

}  // namespace hirosco::detail
