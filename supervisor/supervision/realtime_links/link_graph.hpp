// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"

/// The graph of real-time links (paper 4.3): which are up, which networks they form. A link is up for use until one end lets go of
/// it, and joins its ends until both have: the word of one alone takes nobody out of the reach of a fence (docs/adr/0068).
namespace hirosco::supervisor {

class LinkGraph {
 public:
  explicit LinkGraph(const descriptor::Mission& mission);

  /// Up: both ends hold it. Down: of no use any more, and held by whoever has not let go of it.
  void set_up(std::uint8_t link, bool up);
  /// One end says that it has.
  void let_go(std::uint8_t link, std::uint16_t apid);
  /// Who holds it and whether it is up, as it was told or found before: bits of `Standing`.
  enum Standing : std::uint8_t { stands_up = 1, from_holds = 2, to_holds = 4 };
  [[nodiscard]] std::uint8_t standing(std::uint8_t link) const noexcept;
  void stand(std::uint8_t link, std::uint8_t standing) noexcept;
  /// Nobody holds it any more.
  void forget(std::uint8_t link);
  /// Who is gone holds nothing, nor can anybody be held by it.
  void forget_all_of(std::uint16_t apid);
  struct HalfHeld {
    std::uint8_t link{};
    std::uint16_t gone{};  ///< the end that says that it has let go
    std::uint16_t holder{};  ///< the one that does not
  };
  [[nodiscard]] std::vector<HalfHeld> half_held() const;
  [[nodiscard]] bool is_up(std::uint8_t link) const noexcept;
  /// Whether this end of it has not let go yet.
  [[nodiscard]] bool holds(std::uint8_t link, std::uint16_t apid) const noexcept;
  /// Whether either end has not: it joins them still.
  [[nodiscard]] bool is_held(std::uint8_t link) const noexcept;
  [[nodiscard]] std::size_t up_count() const noexcept;
  [[nodiscard]] std::size_t defined_count() const noexcept { return edges_.size(); }
  /// The real-time network of a subsystem: all that are transitively connected to it by links that are up or that one end
  /// still holds, itself included, in ascending order.
  [[nodiscard]] std::vector<std::uint16_t> network_of(std::uint16_t apid) const;
  /// Of those the ones whom its loss takes down: who only goes on, or falls back, without its sets is not joined by their links
  /// (docs/adr/0077), nor is anybody behind it.
  [[nodiscard]] std::vector<std::uint16_t> taken_down_with(std::uint16_t apid) const;
  /// Links that are up from one of these to somebody else.
  [[nodiscard]] std::vector<std::uint8_t> links_out_of(const std::vector<std::uint16_t>& members) const;
  /// Links that are up with this subsystem at either end.
  [[nodiscard]] std::vector<std::uint8_t> links_of(std::uint16_t apid) const;
  /// The mission's link into a required set: the one that is up, else the first; 0 when there is none.
  [[nodiscard]] std::uint8_t link_into(std::uint16_t consumer, std::string_view required_set) const noexcept;
  /// A link that this configuration requires and that is not up (paper 4.3); its id, or 0 when the mission has none.
  [[nodiscard]] std::optional<std::uint8_t> absent_for(std::uint16_t consumer,
                                                       const descriptor::Configuration& configuration) const noexcept;

 private:
  struct Edge {
    std::uint8_t link{};
    std::uint16_t from{};
    std::uint16_t to{};
    std::string_view required_set;
    bool takes_down{true};  ///< its consumer, who has lost it
    bool up{false};
    bool from_holds{false};
    bool to_holds{false};
    [[nodiscard]] bool joins() const noexcept { return from_holds || to_holds; }
  };
  [[nodiscard]] Edge* find(std::uint8_t link) noexcept;
  std::vector<Edge> edges_;
};

}  // namespace hirosco::supervisor
