// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hirosco/utilities/octets.hpp"

namespace hirosco::communication {

/// The ends of telecommands that went down to ground. A supervisor that goes on for one that died cannot know whether the last ends
/// which that one handed over here went down. It tells them as unknown (docs/adr/0134): where the true end did, ground needs no second. Or, of a
/// SAFE_ALL, it tells the same end again (docs/adr/0243): where that went down, ground needs it no more.
/// After `kept` more to its addressee one is forgotten, sooner where another addressee's has its place, and stands against nothing.  Thread: the ground link's service loop. Realtime: bounded.
class ToldEnds {
 public:
  static constexpr std::size_t kept = 4096;
  /// A telecommand goes up: what went down before with its request id, which comes again after 16,384, was of another one.
  void went_up(Octets telecommand) noexcept;
  /// A report is to go down, and is remembered if it tells an end (TM[1,2], [1,4], [1,7], [1,8], [1,10]).
  /// \return false: it tells an outcome as unknown that has gone down already, or is the supervisor's and tells of a telecommand that went up
  /// here what has gone down already.
  [[nodiscard]] bool goes_down(Octets report) noexcept;

 private:
  /// Of a telecommand: its first four octets, and who sent it. 0 is no telecommand's.
  struct End {
    std::uint32_t request{0};
    std::uint16_t source{0};
    bool went_up{false};  ///< the telecommand did, and none since that has its request id
    std::uint8_t due{0};  ///< ends of such that went up and have none yet
    std::uint64_t told{0};  ///< what was: the subtype, and a checksum of the report; 0: nothing yet
    [[nodiscard]] bool is_of(const End& other) const noexcept {
      return request == other.request && source == other.source;
    }
  };
  [[nodiscard]] End& place_of(std::uint32_t request) noexcept;
  std::array<End, kept> ends_{};
};

}  // namespace hirosco::communication
