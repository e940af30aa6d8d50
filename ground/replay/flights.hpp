// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "ground/archive/archive.hpp"
#include "ground/model/answered.hpp"
#include "ground/model/model.hpp"

namespace hirosco::ground {

/// The flights of an archive. One is told from another by the cycles that the supervisor tells of everybody: as long as one subsystem goes
/// on counting, it is the same flight, also when the supervisor itself was replaced (docs/adr/0093). Thread: one.
class Flights {
 public:
  static constexpr std::size_t longest_name = 80;
  static constexpr std::size_t longest_note = 1000;  ///< octets
  static constexpr std::size_t most_notes = 100;  ///< of one flight

  Flights(const Catalogue& catalogue, Archive& archive);

  /// After each packet that the model took; true: another flight has begun.
  bool hear(const Model& model);
  [[nodiscard]] OnboardTime began() const noexcept { return began_; }
  /// {id, from}
  [[nodiscard]] nlohmann::json present() const;
  /// {flights: [{id, from, to, name, named_by, notes: [{t, who, text}], high, medium, commands}]}, newest first; notes oldest first.
  [[nodiscard]] nlohmann::json list() const;
  /// {flight, name}
  [[nodiscard]] Answered<nlohmann::json> name(const nlohmann::json& body, const std::string& who, OnboardTime now);
  /// {flight, note}: one more, which stays; {flight, notes}. 409: it has as many as it may.
  [[nodiscard]] Answered<nlohmann::json> note(const nlohmann::json& body, const std::string& who, OnboardTime now);

 private:
  /// What a subsystem had counted at a time.
  struct Count {
    OnboardTime t{};
    std::uint32_t cycles{0};
  };
  [[nodiscard]] std::vector<Count> counts_of(const Model& model) const;
  /// Whether one of them counted on.
  [[nodiscard]] bool goes_on(const std::vector<Count>& now, const Model& model) const;
  [[nodiscard]] Duration period_of(std::size_t subsystem, const Model& model) const;
  void begin(OnboardTime t);
  /// The number of the flight that is asked for, as marks have it.
  [[nodiscard]] Answered<std::string> number_of(const nlohmann::json& body, const std::vector<StoredMark>& marks) const;
  /// The counts that the archive ends with.
  void read_counts();

  const Catalogue& catalogue_;
  Archive& archive_;
  std::vector<Count> counts_;
  OnboardTime heard_{};  ///< newest packet of the present flight
  OnboardTime began_{};
  std::int64_t number_{0};
};

}  // namespace hirosco::ground
