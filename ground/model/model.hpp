// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ground/archive/archive.hpp"
#include "ground/model/catalogue.hpp"
#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "hirosco/pus/words/describe.hpp"

/// The spacecraft as its packets tell it: newest values, mode, states, links. The live view and every replay have one
/// each; both are fed with the same packets by the same code.
namespace hirosco::ground {

struct Value {
  double number{};                   ///< not a number where it is words
  OnboardTime t{};
  std::uint64_t revision{0};         ///< 0 = never heard
  std::string words{};               ///< of TEXT
};

/// All that is told of one subsystem: a row of the supervisor's SUBSYSTEMS, and its own events.
struct SubsystemView {
  bool known{false};                 ///< the supervisor has told of it
  std::optional<descriptor::State> state;  ///< empty = does not run, or not known
  OnboardTime state_at{};
  OnboardTime t{};                   ///< of the newest word on it
  std::uint8_t configuration{0};
  std::uint32_t inhibited{0};
  std::uint32_t cycles{0}, overruns{0}, missed{0}, latency_max_ns{0}, execution_mean_ns{0};
  std::uint32_t memory_kb{0};        ///< 0 = not told
};

/// How many samples of a link took how long until they were used, since it was made: at most 1/64, 1/32, 1/16, 1/8, 1/4, 1/2, 1 and 2
/// periods of its producer, and longer.
struct LatencyHistogram {
  static constexpr std::size_t bins = 9;
  double period_ns{};
  std::array<double, bins> counts{};
};

/// All that is told of one link: a row of the supervisor's LINK_STATUS.
struct LinkView {
  bool known{false};
  bool up{false};
  std::optional<double> rate_hz;
  std::optional<double> age_cycles;  ///< in cycles of the consumer
  std::optional<std::uint32_t> samples;  ///< none: they pass nobody who could tell
  // As the consumer tells while the link is up; empty = it cannot.
  std::optional<double> lost;  ///< samples that it never saw
  std::optional<double> latency_mean_ns, latency_max_ns;  ///< from the instant of a sample to its first use
  std::optional<double> jitter_ns;  ///< mean distance of two latencies in a row
  std::optional<double> age_at_use_us;  ///< of the newest sample, in the consumer's newest cycle
  std::optional<LatencyHistogram> latencies;
};

/// A report of ST[01] in words.
struct Verdict {
  std::uint16_t destination{};
  std::uint32_t request_id{};
  std::string stage;  ///< as StoredReport::stage; "failed" for every failure but that of one step
  std::optional<int> code;
  std::string reason;
  bool last{false};  ///< no further report of the request follows
};

/// The answer to "would it be permitted?".
struct PermissionAnswer {
  std::uint16_t destination{};
  std::uint32_t request_id{};
  bool permitted{false};
  int code{0};
};

/// The answer to "what would this mode take?".
struct ModeAnswer {
  std::uint16_t destination{};
  pus::st129::ModePreview preview;
};

/// What a packet said besides values.
struct Heard {
  std::optional<StoredEvent> event;
  std::vector<StoredChange> changes;
  std::optional<Verdict> verdict;
  std::optional<PermissionAnswer> answer;
  std::optional<ModeAnswer> mode_answer;
  std::vector<std::byte> telecommand;  ///< copy of one that the supervisor has received from a ground; empty = none
  std::uint16_t sid{0};
};

class Model {
 public:
  /// `catalogue` outlives the model.
  explicit Model(const Catalogue& catalogue);

  Heard take(const pus::TelemetryView& packet);

  [[nodiscard]] const std::vector<Value>& values() const noexcept { return values_; }
  /// Rises with everything that take() changes; values carry the revision that changed them.
  [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }
  /// The revision of the last change of anything but values.
  [[nodiscard]] std::uint64_t status_revision() const noexcept { return status_revision_; }
  [[nodiscard]] OnboardTime newest() const noexcept { return newest_; }
  [[nodiscard]] const std::string& mode() const noexcept { return mode_; }  ///< empty = not known
  /// In the order of Catalogue::subsystems().
  [[nodiscard]] const std::vector<SubsystemView>& subsystems() const noexcept { return subsystems_; }
  /// In the order of the mission.
  [[nodiscard]] const std::vector<LinkView>& links() const noexcept { return links_; }
  /// What a subsystem waits for on its way up; empty when nothing.
  [[nodiscard]] std::string waits_for(std::size_t subsystem) const;

 private:
  /// What was told at times that have not been yet is as old as can be, and everything newer than `t` counts again.
  void set_back(OnboardTime t);
  void take_housekeeping(const pus::TelemetryView& packet, Heard& heard);
  void take_overview(OnboardTime t, Heard& heard);
  void take_links(OnboardTime t, Duration since, Heard& heard);
  void take_event(const pus::TelemetryView& packet, Heard& heard);
  void take_state(std::size_t subsystem, std::optional<descriptor::State> state, OnboardTime t, Heard& heard);
  [[nodiscard]] std::optional<LatencyHistogram> latencies_of(std::uint8_t link, std::size_t row) const;
  [[nodiscard]] double told(const std::optional<std::size_t>& column, std::size_t i) const;

  const Catalogue& catalogue_;
  pus::PacketDescriber describer_;
  std::vector<Value> values_;
  std::vector<SubsystemView> subsystems_;
  std::vector<LinkView> links_;
  std::string mode_;
  std::uint64_t revision_{0};
  std::uint64_t status_revision_{0};
  OnboardTime newest_{};
  OnboardTime overview_at_{};
  struct OverviewColumns {
    std::optional<std::size_t> mode, apid, state, configuration, inhibited, cycles, overruns, missed, latency,
        execution, memory;
    std::optional<std::size_t> link, up, samples, age, lost, link_latency_mean, link_latency_max, jitter, age_at_use;
    std::optional<std::size_t> latency_link, latency_period;
    std::array<std::optional<std::size_t>, LatencyHistogram::bins> latency_bins;
  };
  OverviewColumns overview_;
  std::size_t subsystem_rows_{0}, link_rows_{0}, latency_rows_{0};
};

}  // namespace hirosco::ground
