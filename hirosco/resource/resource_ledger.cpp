// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/resource/resource_ledger.hpp"

#include <algorithm>
#include <utility>

namespace hirosco {

Result<> ResourceLedger::declare(std::string kind, std::uint64_t limit) {
  if (find(kind) != nullptr) return fail(ErrorCode::AlreadyExists, "kind of resource");
  kinds_.push_back({std::move(kind), {limit, 0, 0}, {}});
  return ok();
}

Result<> ResourceLedger::change_limit(std::string_view kind, std::uint64_t limit) noexcept {
  Kind* const of = find(kind);
  if (of == nullptr) return fail(ErrorCode::NotFound, "kind of resource");
  if (of->usage.used > limit)
    return fail(ErrorCode::NotPermitted, "more is granted than the new limit",
                static_cast<std::int64_t>(of->usage.used));
  of->usage.limit = limit;
  return ok();
}

Result<> ResourceLedger::claim(SubsystemId holder, std::string_view kind, std::uint64_t amount) {
  Kind* const of = find(kind);
  if (of == nullptr) return fail(ErrorCode::NotFound, "kind of resource");
  const std::uint64_t left = of->usage.limit - of->usage.used;
  if (amount > left) return fail(ErrorCode::ResourceExhausted, "resource", static_cast<std::int64_t>(left));
  auto grant = std::ranges::find(of->grants, holder, &Grant::holder);
  if (grant == of->grants.end()) grant = of->grants.insert(grant, {holder, 0});
  grant->amount += amount;
  of->usage.used += amount;
  of->usage.high_water = std::max(of->usage.high_water, of->usage.used);
  return ok();
}

Result<> ResourceLedger::claim(SubsystemId holder, std::span<const ResourceAmount> amounts) {
  std::vector<Kind> before = kinds_;
  for (const ResourceAmount& wanted : amounts) {
    const Result<> claimed = claim(holder, wanted.kind, wanted.amount);
    if (claimed) continue;
    kinds_ = std::move(before);
    return claimed;
  }
  return ok();
}

Result<> ResourceLedger::release(SubsystemId holder, std::string_view kind, std::uint64_t amount) noexcept {
  Kind* const of = find(kind);
  if (of == nullptr) return fail(ErrorCode::NotFound, "kind of resource");
  const auto grant = std::ranges::find(of->grants, holder, &Grant::holder);
  const std::uint64_t has = grant == of->grants.end() ? 0 : grant->amount;
  if (amount > has) return fail(ErrorCode::OutOfRange, "more released than held", static_cast<std::int64_t>(has));
  if (grant != of->grants.end()) give_back(*of, *grant, amount);
  return ok();
}

void ResourceLedger::release_all(SubsystemId holder) noexcept {
  for (Kind& kind : kinds_) {
    const auto grant = std::ranges::find(kind.grants, holder, &Grant::holder);
    if (grant != kind.grants.end()) give_back(kind, *grant, grant->amount);
  }
}

void ResourceLedger::give_back(Kind& kind, Grant& grant, std::uint64_t amount) noexcept {
  grant.amount -= amount;
  kind.usage.used -= amount;
  if (grant.amount == 0) kind.grants.erase(kind.grants.begin() + (&grant - kind.grants.data()));
}

Result<ResourceUsage> ResourceLedger::usage(std::string_view kind) const noexcept {
  const Kind* const of = find(kind);
  if (of == nullptr) return fail(ErrorCode::NotFound, "kind of resource");
  return of->usage;
}

std::uint64_t ResourceLedger::held(SubsystemId holder, std::string_view kind) const noexcept {
  const Kind* const of = find(kind);
  if (of == nullptr) return 0;
  const auto grant = std::ranges::find(of->grants, holder, &Grant::holder);
  return grant == of->grants.end() ? 0 : grant->amount;
}

std::vector<std::string_view> ResourceLedger::kinds() const {
  std::vector<std::string_view> names;
  for (const Kind& kind : kinds_) names.push_back(kind.name);
  return names;
}

ResourceLedger::Kind* ResourceLedger::find(std::string_view kind) noexcept {
  const auto found = std::ranges::find(kinds_, kind, &Kind::name);
  return found == kinds_.end() ? nullptr : &*found;
}

const ResourceLedger::Kind* ResourceLedger::find(std::string_view kind) const noexcept {
  const auto found = std::ranges::find(kinds_, kind, &Kind::name);
  return found == kinds_.end() ? nullptr : &*found;
}

}  // namespace hirosco
