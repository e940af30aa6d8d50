// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

/// Books of one kind of resource (paper 4.3): what there is of it, what is promised, to whom. Electrical power and everything
/// else that can run out are kept in such books; amounts are whole numbers of the kind's unit.
namespace hirosco::supervisor {

/// Why something does not fit.
struct Shortage {
  std::uint32_t budget{};
  std::uint32_t reserved{};  ///< by all others
  std::uint32_t requested{};
};

/// Whoever asks first is never promised more than the budget. Thread: the supervisor's.
class Book {
 public:
  /// Empty: not limited.
  void set_budget(std::optional<std::uint32_t> budget) noexcept { budget_ = budget; }
  /// What `holder` already has would be replaced, so it does not count.
  [[nodiscard]] std::optional<Shortage> shortage(std::uint16_t holder, std::uint32_t amount) const noexcept {
    return limited() ? shortage(holder, amount, budget()) : std::nullopt;
  }
  /// Of a budget that holds for who asks now, whatever holds for what is taken.
  [[nodiscard]] std::optional<Shortage> shortage(std::uint16_t holder, std::uint32_t amount,
                                                 std::uint32_t budget) const noexcept;
  /// In place of what it had; 0 strikes it out. Asks nobody: what is taken is taken.
  void hold(std::uint16_t holder, std::uint32_t amount);

  [[nodiscard]] bool limited() const noexcept { return budget_.has_value(); }
  [[nodiscard]] std::uint32_t budget() const noexcept { return budget_.value_or(0); }
  [[nodiscard]] std::uint32_t reserved() const noexcept;
  [[nodiscard]] std::uint32_t held(std::uint16_t holder) const noexcept;
  /// More is taken than there is: the budget was lowered, or somebody did not ask.
  [[nodiscard]] bool overdrawn() const noexcept { return limited() && reserved() > budget(); }

 private:
  struct Entry {
    std::uint16_t holder{};
    std::uint32_t amount{};
  };
  std::optional<std::uint32_t> budget_;
  std::vector<Entry> entries_;
};

}  // namespace hirosco::supervisor
