// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/mission.hpp"

/// The graph of real-time links (paper 4.3): which are up, which networks they form.
namespace hirosco::supervisor {

class LinkGraph {
 public:
  explicit LinkGraph(const descriptor::Mission& mission);

  void set_up(std::uint8_t link, bool up);
  [[nodiscard]] bool is_up(std::uint8_t link) const noexcept;
  [[nodiscard]] std::size_t up_count() const noexcept;
  [[nodiscard]] std::size_t defined_count() const noexcept { return edges_.size(); }
  /// The real-time network of a subsystem: all that are transitively connected to it by links that are up, itself
  /// included, in ascending order.
  [[nodiscard]] std::vector<std::uint16_t> network_of(std::uint16_t apid) const;
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
    bool up{false};
  };
  std::vector<Edge> edges_;
};

}  // namespace hirosco::supervisor
