// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "ground/archive/archive.hpp"
#include "ground/model/answered.hpp"

namespace hirosco::ground {

/// Lists of telecommands that somebody keeps for everybody at the station: a name and lines of `hirosco tc`, which the station only keeps;
/// each line is judged when it is sent. They outlive flights and stations with the archive. Thread: one.
class Stacks {
 public:
  static constexpr std::size_t most_stacks = 64;
  static constexpr std::size_t longest_name = 80;  ///< octets
  static constexpr std::size_t longest_text = 20'000;  ///< octets

  /// Those that the archive has.
  explicit Stacks(Archive& archive);

  /// {name, text} by `who`: in place of the one of that name; without a text it is forgotten (404: there is none). All that there are.
  [[nodiscard]] Answered<nlohmann::json> keep(const nlohmann::json& body, const std::string& who, OnboardTime now);
  /// {stacks: [{name, text, t, who}]}, the newest first.
  [[nodiscard]] nlohmann::json list() const;

 private:
  void apply(const StoredMark& mark);

  Archive& archive_;
  std::vector<StoredMark> kept_;  ///< oldest first; the text is the note
};

}  // namespace hirosco::ground
