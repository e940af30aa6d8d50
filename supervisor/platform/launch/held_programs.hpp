// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "hirosco/descriptor/model/mission.hpp"
#include "supervisor/platform/launch/launcher.hpp"
#include "supervisor/platform/launch/program_image.hpp"

namespace hirosco::supervisor {

/// The executables of a mission that has a manifest, in memory, each with the digest that stands there for its name. They are
/// read before the flight; who crashed is started anew from memory, and waits for no
/// disk and no hash. A supervisor that goes on for another one reads them anew, from the disk, beside the flight (docs/adr/0192).
/// Thread: the supervisor's; a file is read by a thread of its own, one at most for each name: one that hangs holds up no other. Nobody waits longer
/// than longest_wait for all that are read at once.
class HeldPrograms {
 public:
  using Outcome = std::expected<ProgramImage, StartRefusal>;
  using Read = Result<ProgramImage> (*)(const std::string& name);
  /// Well below what the supervisor's loop may stand still for.
  static constexpr Duration longest_wait = std::chrono::milliseconds{100};

  /// Of a mission with a manifest. `read` finds the file of a name and reads it; without it beside this program and in PATH.
  explicit HeldPrograms(const descriptor::Mission& mission);
  HeldPrograms(const descriptor::Mission& mission, Read read);

  /// Reads those of all subsystems, before the flight: it takes as long as the disk takes. What is refused is so by find().
  void read_all(const descriptor::Mission& mission);
  /// The same beside a flight: at once, in threads of ordinary priority, for which nobody waits here. Until one is there find() says that it is
  /// still being read. Where no thread is left the others are read when they are asked for.
  void read_all_beside(const descriptor::Mission& mission);
  /// One that is not held is read anew: its file or the disk may be in order by now. The image stays for the flight.
  /// `patience` is for one that nothing else is being read beside, itself neither; else it is to be asked for again.
  /// A version of one, "arm@2", may have come in flight: with it the manifest is read anew.
  [[nodiscard]] std::expected<const ProgramImage*, StartRefusal> find(const std::string& name,
                                                                      Duration patience = longest_wait);
  void drop(const std::string& name) { held_.erase(name); }
  [[nodiscard]] std::size_t count() const noexcept { return held_.size(); }
  [[nodiscard]] std::size_t octets() const noexcept;

 private:
  struct Wanted {
    std::string name;
    std::string digest;  ///< empty: it stands in the manifest as it is then
    std::string mission;
    std::filesystem::path manifest;
  };
  [[nodiscard]] static Outcome check(Read read, Wanted wanted);
  [[nodiscard]] static StartRefusal not_listed(const Wanted& wanted);
  [[nodiscard]] static std::optional<StartRefusal> look_up(Wanted& wanted);
  [[nodiscard]] std::expected<Wanted, StartRefusal> wanted(const std::string& name) const;
  /// False: no thread is left.
  [[nodiscard]] bool begin_to_read(std::future<Outcome>& reading, Wanted listed) const;
  [[nodiscard]] bool any_is_read_now() const;

  descriptor::Manifest manifest_;
  std::string mission_;
  Read read_;
  std::map<std::string, ProgramImage, std::less<>> held_;
  std::map<std::string, std::future<Outcome>, std::less<>> read_now_;
};

}  // namespace hirosco::supervisor
