// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/descriptor/read/read.hpp"
#include "supervisor/platform/launch/descriptor_readings.hpp"
#include "supervisor/supervision/command_desk.hpp"
#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/subsystem_handling/fresh_descriptor.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

class StoredValues;
class UnderWay;

/// Reads a descriptor again while it is flown, in Offline and Pre-Operational (docs/adr/0095): the mission is judged as a whole with the
/// new text, everybody who flies the file is asked, then all take it and the supervisor with them, or nothing changes.
/// Thread: the supervisor's.
class Descriptors final : public Watch {
 public:
  struct Parts {
    Craft& craft;
    OwnSubsystem& own;
    CommandDesk& desk;
    const UnderWay& under_way;
    StoredValues& stored;
    DescriptorReadings* readings;  ///< null: descriptors are what they were at the start
  };
  /// What a file may take to be read.
  static constexpr Duration longest_reading = 60s;

  explicit Descriptors(const Parts& parts) : parts_{parts}, craft_{parts.craft} {}

  /// REREAD.
  void provide();
  [[nodiscard]] Outcome reread(std::uint16_t apid, const Call& call);
  void watch(TimePoint now) override;

 private:
  enum class Phase : std::uint8_t { Idle, Reading, Judging, Taking };
  enum class Answer : std::uint8_t { Open, Yes, No, None };
  struct Asked {
    Answer answer{Answer::Open};
    std::string why;
    std::uint32_t process{0};  ///< which was asked: another one has begun with the text before
  };

  [[nodiscard]] std::optional<Outcome> against(const Member* subject) const;
  [[nodiscard]] std::vector<descriptor::MissionSubsystem*> flying(const std::filesystem::path& file);
  void judge(DescriptorReading reading);
  /// What of `fresh` does not fit who flies it now.
  void compare(const descriptor::MissionSubsystem& flown, descriptor::MissionSubsystem& fresh,
               DescriptorProblems& problems) const;
  void ask(std::uint8_t subtype, Octets data, const MemoryHandle& text);
  void judged();
  /// Everybody who runs, to what it is about to take (docs/adr/0236).
  [[nodiscard]] DescriptorProblems let_in();
  void let_go();
  void taken();
  void take_over();
  void refuse(const DescriptorProblems& problems);
  void finish();
  void give_up(pus::FailureCode code, const char* words, std::int64_t number = 0);
  void hold(bool held);

  Parts parts_;
  Craft& craft_;
  Phase phase_{Phase::Idle};
  std::uint16_t apid_{0};
  std::filesystem::path file_;
  std::optional<Call> call_;
  TimePoint deadline_{};
  bool late_{false};  ///< a reading that was given up has not ended
  std::uint32_t round_{0};  ///< answers to an earlier one count for nothing
  std::shared_ptr<const std::string> text_;
  MissionTexts texts_;  ///< all that the newest reading read
  std::map<std::uint16_t, descriptor::SubsystemDescriptor> declared_;  ///< the same before anything was set
  std::map<std::uint16_t, descriptor::MissionSubsystem> fresh_;  ///< by APID: who flies the file
  std::map<std::uint16_t, Asked> asked_;  ///< of them those whose process runs
};

}  // namespace hirosco::supervisor
