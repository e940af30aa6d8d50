// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "hirosco/utilities/enum_text.hpp"
#include "tools/doctor/system.hpp"

/// What `hirosco doctor` says, a row for each thing (docs/adr/0109).
namespace hirosco::tools::doctor {

enum class Verdict : std::uint8_t {
  Ok,
  WorthKnowing,  ///< a mission flies with its figures all the same
  Missing,       ///< it does not
};

struct Finding {
  Verdict verdict{Verdict::Ok};
  std::string found;  ///< what is there
  std::string mends;  ///< the line to type; empty where nothing is to mend, or no line does
};

/// A thing that is judged.
struct Row {
  const char* name;
  const char* good_for;
  Finding (*judge)(const System&);
};

/// Where it is missing a mission flies all the same, with cycles that may come later.
[[nodiscard]] bool of_time(const Row& row);
/// All of them, in the order in which they are told.
[[nodiscard]] std::span<const Row> rows();

}  // namespace hirosco::tools::doctor

namespace hirosco {

template <>
struct EnumTexts<tools::doctor::Verdict> {
  static constexpr auto table = enum_table<tools::doctor::Verdict>({
      {tools::doctor::Verdict::Ok, "ok"},
      {tools::doctor::Verdict::WorthKnowing, "worth knowing"},
      {tools::doctor::Verdict::Missing, "missing"},
  });
};

}  // namespace hirosco
