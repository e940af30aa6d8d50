// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/utilities/processor_share.hpp"
#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/resource_management/book.hpp"
#include "supervisor/supervision/resource_management/core_books.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

/// Books of what the processes of the subsystems take of their computer, and an eye on whoever takes more than its descriptor
/// says (paper 4.3 resource management; docs/adr/0080). Thread: the supervisor's.
class ResourceHandling final : public Watch {
 public:
  /// Processor time has to be too much in so many windows in a row (ProcessorShare): one busy second is no runaway.
  static constexpr int windows_too_much = 3;

  ResourceHandling(Craft& craft, OwnSubsystem& own);

  /// Before it is started. Empty: all that its descriptor says is promised to it; else nothing is, and it is told why.
  [[nodiscard]] std::optional<std::string> claim(const Member& member);
  /// It has ended, or could not be started.
  void release(std::uint16_t apid);
  [[nodiscard]] const Book& book(descriptor::Resource resource) const noexcept {
    return books_[static_cast<std::size_t>(resource)];
  }
  [[nodiscard]] const Book& core(std::uint16_t core) { return cores_.book(core); }
  /// One member in its turn: who has taken more than it may is ended and named.
  void watch(TimePoint now) override;

 private:
  struct Seen {
    std::uint32_t process{0};
    ProcessorShare processor{};
    int too_much{0};
    std::uint32_t others{
        0};  ///< the look by which it had others beside it when it was settled for the first time; 0: it has none
    bool ended{false};  ///< told: it is on its way out
    bool settled{false};  ///< this process has come to Pre-Operational: each thread is where it is to be
  };
  struct Excess {
    descriptor::Resource resource{};
    std::uint32_t used{0};
    std::uint32_t limit{0};
  };
  [[nodiscard]] std::optional<Excess> excess_of(const Member& member, Seen& seen, const ProcessUsage& usage);
  [[nodiscard]] std::string refuse(const Member& member, descriptor::Resource resource, const Shortage& shortage);
  void watch_cores(const Member& member, Seen& seen);
  /// `what` it has done, in words.
  void end(const Member& member, const Excess& excess, const std::string& what);

  Craft& craft_;
  OwnSubsystem& own_;
  std::array<Book, descriptor::counted_resources> books_;
  CoreBooks cores_;
  std::map<std::uint16_t, Seen> seen_;
  std::size_t turn_{0};
};

}  // namespace hirosco::supervisor
