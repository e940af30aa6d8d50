// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "supervisor/platform/launch/descriptor_readings.hpp"
#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/subsystem_handling/fresh_descriptor.hpp"

namespace hirosco::supervisor {

class StoredValues;

/// The text of its descriptor that comes with another version of a program, and the one to go back to (docs/adr/0214). A text is put in force
/// while no process of the subsystem runs. Those to go back to are kept among the texts of the mission, as FILE/@VERSION, where the next
/// supervisor finds them.  Thread: the supervisor's.
class VersionTexts {
 public:
  struct Parts {
    Craft& craft;
    OwnSubsystem& own;
    StoredValues& stored;
    DescriptorReadings* readings;  ///< null: descriptors are what they were at the start
  };
  enum class Found : std::uint8_t {
    NotYet,  ///< ask again
    InForce,  ///< the file says what is in force
    Another,  ///< it says more: take() puts it in force
    Refused,  ///< told
  };

  explicit VersionTexts(const Parts& parts) : parts_{parts}, craft_{parts.craft} {}

  /// What its file says now, read by another thread and judged with the whole mission. Problems are told to `asked_by`.
  [[nodiscard]] Found look(Member& subject, std::uint16_t asked_by);
  /// Of the newest that was refused.
  [[nodiscard]] std::size_t problems() const noexcept { return problems_; }
  /// What was looked for or found is not taken.
  void let_go(Member& subject);
  /// In each step: what a disk gave too late.
  void watch();

  /// What was found is in force from now on; the text before is kept as that of the version `leaving`.
  void take(const Member& subject, const std::string& leaving);
  /// It flew by another text than the one in force.
  [[nodiscard]] bool has(std::uint16_t apid, const std::string& version) const {
    return kept_.contains({apid, version});
  }
  /// The text of `version`, which it has(), is in force again; that in force is kept as that of `leaving`, unless it has one.
  void go_back(const Member& subject, const std::string& leaving, const std::string& version);
  /// Of other versions none is needed any more; null: of none at all.
  void keep_only(const Member& subject, const std::string* version);
  /// Under another supervisor this version flew by another text. False: it did not.  Realtime: reads the mission from memory.
  bool recall(const Member& subject, const std::string& version);

 private:
  /// Found, judged, and not taken yet.
  struct Fresh {
    descriptor::MissionSubsystem declared;  ///< before anything was set
    std::shared_ptr<const std::string> text;
    MissionTexts texts;  ///< that were read with it
  };
  [[nodiscard]] descriptor::MissionSubsystem& flown(const Member& subject);
  [[nodiscard]] Found judge(Member& subject, DescriptorReading reading, std::uint16_t asked_by);
  void keep(const descriptor::MissionSubsystem& flown, const std::string& version);
  void put(descriptor::MissionSubsystem& flown, descriptor::MissionSubsystem declared, std::string_view how);
  [[nodiscard]] std::size_t octets_beside(const std::string& text, const MissionTexts& read) const;

  Parts parts_;
  Craft& craft_;
  std::optional<std::uint16_t> reading_;  ///< whose file
  bool late_{false};  ///< what is being read nobody wants any more
  std::size_t problems_{0};
  std::map<std::uint16_t, Fresh> fresh_;
  std::map<std::pair<std::uint16_t, std::string>, descriptor::MissionSubsystem> kept_;  ///< as declared
};

}  // namespace hirosco::supervisor
