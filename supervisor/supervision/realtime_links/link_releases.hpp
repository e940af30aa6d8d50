// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "supervisor/supervision/realtime_links/link_graph.hpp"
#include "supervisor/supervision/realtime_links/link_operator.hpp"

namespace hirosco::supervisor {

/// Links that are being taken down at whichever end holds them, each until none does. Thread: the supervisor's.
class LinkReleases {
 public:
  /// How one ended: nobody holds the link any more, an end refused to let go, or one said nothing in its time.
  enum class Released : std::uint8_t { ByBoth, Refused, Unanswered };
  using Done = std::function<void(Released)>;

  LinkReleases(const descriptor::Mission& mission, const LinkGraph& graph, LinkOperator& supervisor)
      : mission_{mission}, graph_{graph}, operator_{supervisor} {}

  /// Tells those that hold it to let go.
  void begin(std::uint8_t link, Done done);
  [[nodiscard]] bool under_way(std::uint8_t link) const { return releases_.contains(link); }
  [[nodiscard]] std::vector<std::uint8_t> links() const;
  /// Whoever holds on would not let go: it ends with the next step().
  void refused(std::uint8_t link, std::uint16_t apid);
  /// Those whose link nobody holds any more, however that came about.
  void end_those_let_go();
  /// These, those refused, and those whose time is over.
  void step(TimePoint now);

 private:
  struct Release {
    Done done;
    TimePoint deadline{};  ///< set by the first step() after it was asked for
    bool refused{false};  ///< by an end that holds on
  };
  const descriptor::Mission& mission_;
  const LinkGraph& graph_;
  LinkOperator& operator_;
  std::map<std::uint8_t, Release> releases_;
};

}  // namespace hirosco::supervisor
