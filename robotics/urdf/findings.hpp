// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hirosco/xml/reader.hpp"
#include "robotics/urdf/robot.hpp"

/// Of the reader: collects what is wrong.
namespace hirosco::robotics::urdf {

/// More problems than this are not worth reading.
inline constexpr std::size_t max_findings = 200;

/// No robot has larger numbers; what is smaller leaves room for sums and products of all of them.
inline constexpr double largest_number = 1e20;
inline constexpr double smallest_multiplier = 1e-9;

/// 'text', shortened, so that a message is one line.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// What to do about a file that is no XML, or none that is taken.
[[nodiscard]] const char* hint_of(xml::Refusal refusal, std::string_view reason);

/// One finite decimal number of at most `largest_number`, white space around it.
[[nodiscard]] std::optional<double> number(std::string_view text);
/// Three of them.
[[nodiscard]] std::optional<Vector3> three(std::string_view text);

/// "joint 'lift' slides to 400 m"; empty: a robot may well have these limits.
[[nodiscard]] std::string beyond_reason(const Joint& joint);

class Findings {
 public:
  explicit Findings(std::filesystem::path file) : file_{std::move(file)} {}
  void error(Location at, const char* code, std::string message, std::string hint) {
    add(problems_, descriptor::Grade::Error, at, code, std::move(message), std::move(hint));
  }
  void warning(Location at, const char* code, std::string message, std::string hint) {
    add(warnings_, descriptor::Grade::Warning, at, code, std::move(message), std::move(hint));
  }
  [[nodiscard]] bool good() const noexcept { return problems_.empty(); }
  /// In file order.
  [[nodiscard]] descriptor::Reading<Robot> with(Robot robot) &&;

 private:
  void add(std::vector<Diagnostic>& to, descriptor::Grade grade, Location at, const char* code, std::string message,
           std::string hint) {
    if (to.size() < max_findings) to.push_back({file_, at, code, std::move(message), std::move(hint), 1, grade});
  }
  std::filesystem::path file_;
  std::vector<Diagnostic> problems_;
  std::vector<Diagnostic> warnings_;
};

/// A joint before names are known to be those of links.
struct NamedJoint {
  Joint joint;
  std::string parent;
  std::string child;
  Location parent_at;
  Location child_at;
  std::string mimicked;              ///< empty: moves by itself
  Location mimic_at;
};

/// Whether it is one tree that can move, of a size that there is room for; fills in whom names mean.
void connect(Robot& robot, std::vector<NamedJoint>& joints, Findings& findings);

}  // namespace hirosco::robotics::urdf
