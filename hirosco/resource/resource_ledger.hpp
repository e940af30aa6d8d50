// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/utilities/id.hpp"
#include "hirosco/utilities/result.hpp"

namespace hirosco {

/// An amount of one kind of resource. Amounts are whole numbers of the kind's unit (descriptors, ports, octets, mW).
struct ResourceAmount {
  std::string_view kind;
  std::uint64_t amount{0};
};

struct ResourceUsage {
  std::uint64_t limit{0};
  std::uint64_t used{0};
  std::uint64_t high_water{0};
};

/// Who holds how much of what: grants of a kind never exceed its limit. It keeps books only; the resources themselves
/// are elsewhere.  Realtime: allocates. Thread: one.
class ResourceLedger {
 public:
  /// AlreadyExists for a name that is taken.
  [[nodiscard]] Result<> declare(std::string kind, std::uint64_t limit);
  /// NotFound: no such kind. NotPermitted: more than the new limit is granted.
  [[nodiscard]] Result<> change_limit(std::string_view kind, std::uint64_t limit) noexcept;

  /// Adds to what `holder` has. NotFound: no such kind. ResourceExhausted (value: what is left): refused, nothing changes.
  [[nodiscard]] Result<> claim(SubsystemId holder, std::string_view kind, std::uint64_t amount);
  /// All of them or none.
  [[nodiscard]] Result<> claim(SubsystemId holder, std::span<const ResourceAmount> amounts);
  /// NotFound: no such kind. OutOfRange (value: what it has): `holder` has less, nothing changes.
  [[nodiscard]] Result<> release(SubsystemId holder, std::string_view kind, std::uint64_t amount) noexcept;
  /// Gives back all that `holder` has: it ended.
  void release_all(SubsystemId holder) noexcept;

  [[nodiscard]] Result<ResourceUsage> usage(std::string_view kind) const noexcept;
  /// 0 also for an unknown kind.
  [[nodiscard]] std::uint64_t held(SubsystemId holder, std::string_view kind) const noexcept;
  /// In the order of their declaration.
  [[nodiscard]] std::vector<std::string_view> kinds() const;

 private:
  struct Grant {
    SubsystemId holder;
    std::uint64_t amount;
  };
  struct Kind {
    std::string name;
    ResourceUsage usage;
    std::vector<Grant> grants;
  };
  [[nodiscard]] Kind* find(std::string_view kind) noexcept;
  [[nodiscard]] const Kind* find(std::string_view kind) const noexcept;
  static void give_back(Kind& kind, Grant& grant, std::uint64_t amount) noexcept;

  std::vector<Kind> kinds_;
};

}  // namespace hirosco
