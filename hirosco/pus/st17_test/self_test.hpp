// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>

#include "hirosco/parameter/text.hpp"
#include "hirosco/pus/packet/cuc.hpp"
#include "hirosco/pus/packet/failure_code.hpp"
#include "hirosco/pus/service/service.hpp"
#include "hirosco/utilities/time.hpp"

/// The self test of a subsystem, which its author writes (paper 4.2: Safe-Operational "can be used to verify the proper
/// function"), as ST[17] carries it.
namespace hirosco::pus {

enum class SelfTestOutcome : std::uint8_t {
  NeverRun,  ///< since the configuration was put in force
  Passed,
  Failed,
  Running,
  Void,  ///< it had passed; since then a device was lost, Error-Operational entered or the configuration given back
};

/// What is known of the newest one.
struct SelfTestRecord {
  SelfTestOutcome outcome{SelfTestOutcome::NeverRun};
  std::uint8_t configuration{0};  ///< in which it ran, or that was put in force since; 0 = none ever was
  OnboardTime at{};  ///< when it ended, began while it runs; 0 = it never ran
  FailureCode code{};  ///< of a failed one; 0 = none
  std::int64_t number{0};  ///< the author's, of a failed one
  Text<FailureNotice::max_reason_text_octets>
      reason{};  ///< of a failed one; needs no heap, as it is told in flight (adr 0220)
};

inline constexpr std::size_t max_self_test_octets =
    1 + 1 + cuc_octets + 2 + 8 + 1 + FailureNotice::max_reason_text_octets;
/// Source data of TM[17,129], in `room` of max_self_test_octets: outcome u8, configuration u8, time (CUC 4+3), failure code u16,
/// number i64, length u8 and words.
[[nodiscard]] Octets write_self_test(MutableOctets room, const SelfTestRecord& record) noexcept;

/// Whoever runs it.  Thread: the service loop.
class SelfTest {
 public:
  virtual ~SelfTest() = default;
  /// Begins it, and reports start and completion of what was taken; a notice becomes a failed start.
  [[nodiscard]] virtual std::expected<void, FailureNotice> begin_self_test(const Request& request) = 0;
  [[nodiscard]] virtual SelfTestRecord newest_self_test() const = 0;
};

}  // namespace hirosco::pus

namespace hirosco {
template <>
struct EnumTexts<pus::SelfTestOutcome> {
  using enum pus::SelfTestOutcome;
  static constexpr auto table = enum_table<pus::SelfTestOutcome>(
      {{NeverRun, "never run"}, {Passed, "passed"}, {Failed, "failed"}, {Running, "running"}, {Void, "void"}});
};
}  // namespace hirosco
