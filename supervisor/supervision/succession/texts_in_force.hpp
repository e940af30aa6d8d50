// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "supervisor/supervision/succession/journal.hpp"

namespace hirosco::supervisor {

/// The texts by which a mission flies, its own and its descriptors', in memory that somebody else keeps: whoever goes on for a supervisor that
/// died goes on by them, whatever the files say by then (docs/adr/0114). Thread: one.
class TextsInForce {
 public:
  /// As descriptor::Mission has them.
  using Texts = std::map<std::filesystem::path, std::shared_ptr<const std::string>>;

  /// The memory outlives this; half of it holds them all.
  explicit TextsInForce(MutableOctets memory) noexcept : journal_{memory} {}

  /// Those of the supervisor before. Empty: there was none, or there is no whole copy.
  [[nodiscard]] Texts newest() const;
  /// Notes them where one is another than last time. False: there is no room, and nothing is noted any more.
  bool note(const Texts& texts);

 private:
  Journal journal_;
  std::vector<std::shared_ptr<const std::string>> noted_;
};

}  // namespace hirosco::supervisor
