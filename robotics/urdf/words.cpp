// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>

#include "robotics/urdf/findings.hpp"

namespace hirosco::robotics::urdf {
namespace {

[[nodiscard]] bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

}  // namespace

std::optional<double> number(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !(std::abs(value) <= largest_number))
    return std::nullopt;
  return value;
}

std::optional<Vector3> three(std::string_view text) {
  Vector3 values;
  for (int i = 0; i < 3; ++i) {
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    const std::size_t end = std::min(text.find_first_of(" \t\r\n"), text.size());
    const auto value = number(text.substr(0, end));
    if (!value) return std::nullopt;
    values[i] = *value;
    text.remove_prefix(end);
  }
  return std::ranges::all_of(text, is_space) ? std::optional{values} : std::nullopt;
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t most = 64;
  std::string result{text.substr(0, most)};
  for (char& c : result)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  while (text.size() > most && !result.empty() && (static_cast<unsigned char>(result.back()) & 0x80) != 0)
    result.pop_back();
  return "'" + result + (text.size() > most ? "...'" : "'");
}

const char* hint_of(xml::Refusal refusal, std::string_view reason) {
  // Octets that are no UTF-8 are an encoding; all else that is not well-formed is a tag or a mark too much or too few.
  const bool octets = reason.find("UTF-8") != std::string_view::npos || reason.find("NUL") != std::string_view::npos;
  if (refusal == xml::Refusal::NotWellFormed && !octets)
    return "close each tag that is opened, in its turn: <link ...> by </link>, or <link .../>; quotation marks stand "
           "around each value";
  return "only plain XML in UTF-8 of at most 4 MiB is read; a file of another encoding is converted first, for "
         "example by iconv -f ISO-8859-1 -t UTF-8";
}

std::string beyond_reason(const Joint& joint) {
  constexpr double farthest = 100;  // m, and rad: millimetres and degrees come to more soon
  const double far = std::max(std::abs(joint.limits.lower.value_or(0)), std::abs(joint.limits.upper.value_or(0)));
  if (!(far > farthest)) return {};
  std::string number = std::to_string(far);
  number.erase(number.find('.'));
  const bool slides = joint.type == JointType::Prismatic;
  return "joint " + in_quotes(joint.name) + (slides ? " slides to " : " turns to ") + number + (slides ? " m" : " rad");
}

}  // namespace hirosco::robotics::urdf
