// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "hirosco/descriptor/model/mission.hpp"

/// Links of which an end has left its configuration while the link was up, and which are negotiated anew when both ends have one in
/// force again (docs/adr/0094): the agreement in force is always one of the configurations in force. It decides; it sends nothing.
/// Thread: the supervisor's.
namespace hirosco::supervisor {

class LinkRenewals {
 public:
  /// What the pages of an end say now.
  struct End {
    const descriptor::SubsystemDescriptor* described{nullptr};
    bool there{false};  ///< its process lives and it is not Offline
    bool settled{false};  ///< in a state in which links can be, and not on the way to another
    std::uint8_t configuration{0};  ///< in force; 0: none
  };
  /// An end has let go of a link that was up, by itself; the other one holds on.
  void left(std::uint8_t link, std::uint16_t holder);
  /// The other one has let go, too.
  void let_go(std::uint8_t link, std::uint16_t apid);
  /// It is somebody else's matter now: the link is up, was commanded, or a mode says which there are.
  void drop(std::uint8_t link) { waiting_.erase(link); }
  void drop_all() { waiting_.clear(); }
  [[nodiscard]] bool waits(std::uint8_t link) const { return waiting_.contains(link); }
  /// Who held on when the other end left, and may still hold the link as it was; 0: nobody.
  [[nodiscard]] std::uint16_t holder(std::uint8_t link) const;

  enum class Next : std::uint8_t {
    Wait,
    Establish,
    Refused,  ///< the configurations in force have nothing to join: `why` says which lacks what
    Over,  ///< an end is gone
  };
  struct Judged {
    Next next{Next::Wait};
    std::string why{};
  };
  /// Once for each pair of configurations, until one of them is left again.
  [[nodiscard]] Judged judge(const descriptor::MissionLink& link, const End& from, const End& to);
  template <class Each>
  void for_each(Each each) const {
    const auto now = waiting_;
    for (const auto& [link, waiting] : now) each(link);
  }

 private:
  struct Waiting {
    std::uint16_t holder{0};
    std::optional<std::pair<std::uint8_t, std::uint8_t>> tried{};  ///< configurations of producer and consumer
  };
  std::map<std::uint8_t, Waiting> waiting_;
};

}  // namespace hirosco::supervisor
