// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hirosco/descriptor/model/in_flight.hpp"

/// How two texts of one descriptor are gone through, part by part; which parts there are says in_flight.cpp.
namespace hirosco::descriptor::differences {

inline constexpr std::string_view layout_why = "its place in memory and on the wire was made when the process started";
inline constexpr std::string_view meaning_why = "ground and log read its values by what it was when the flight began";
inline constexpr std::string_view addition_why =
    "a program has to have it: REPLACE starts one that does, in Offline, and takes this text with it";

inline constexpr auto its_name = [](const auto& each) { return each.name; };
inline constexpr auto its_place = [](const auto& each) { return each.at; };
inline constexpr auto no_place = [](const auto&) { return Location{}; };

[[nodiscard]] inline bool is_listed(const auto& list, const auto& wanted, const auto& name) {
  return std::ranges::find(list, wanted, name) != list.end();
}

/// Collects what differs.
class Differences {
 public:
  explicit Differences(TakenBy by) : by_{by} {}
  [[nodiscard]] std::vector<Obstacle> take() { return std::move(found_); }

  void unless(bool same, Location at, std::string what, std::string_view why) {
    if (!same) found_.push_back({at, std::move(what), why});
  }
  /// Who is there by name in one of the two only, then each pair in order.
  template <class T>
  void lists(const std::vector<T>& flown, const std::vector<T>& fresh, const std::string& kind, auto&& name, auto&& at,
             std::string_view why, auto&& pair) {
    bool whole = true;
    const auto told = [&](const T& which, const char* how) {
      found_.push_back({at(which), kind + name(which) + how, why});
      whole = false;
    };
    for (const T& each : fresh)
      if (!is_listed(flown, name(each), name)) told(each, " is new");
    for (const T& each : flown)
      if (!is_listed(fresh, name(each), name)) told(each, " is gone");
    if (!whole) return;
    for (std::size_t i = 0; i < flown.size() && i < fresh.size(); ++i) {
      if (name(flown[i]) != name(fresh[i])) return told(fresh[i], " has another place in the order");
      pair(flown[i], fresh[i]);
    }
  }

  /// The same of what another process may have more of.
  template <class T>
  void growing(const std::vector<T>& flown, const std::vector<T>& fresh, const std::string& kind, auto&& name,
               auto&& at, std::string_view why, auto&& pair) {
    for (const T& each : fresh)
      if (by_ == TakenBy::SameProcess && !is_listed(flown, name(each), name))
        found_.push_back({at(each), kind + name(each) + " is new", addition_why, true});
    kept(flown, fresh, kind, name, at, why, pair);
  }
  /// Only what was there has to be there, in its order.
  template <class T>
  void kept(const std::vector<T>& flown, const std::vector<T>& fresh, const std::string& kind, auto&& name, auto&& at,
            std::string_view why, auto&& pair) {
    auto next = fresh.begin();
    for (const T& each : flown) {
      const auto same = std::ranges::find(fresh, name(each), name);
      unless(same != fresh.end(), at(each), kind + name(each) + " is gone", why);
      if (same == fresh.end()) continue;
      unless(same >= next, at(*same), kind + name(each) + " has another place in the order", why);
      if (same < next) continue;
      pair(each, *same);
      next = same + 1;
    }
  }

  /// But for its range.
  void field(const Field& flown, const Field& fresh, const std::string& what) {
    [[maybe_unused]] const auto& [name, type, count, unit, minimum, maximum, enumeration, at, text, text_octets] =
        fresh;
    unless(flown.name == name, at, what + ": its name", layout_why);
    unless(flown.type == type && flown.text == text, at, what + ": its type", layout_why);
    unless(flown.count == count && flown.text_octets == text_octets, at, what + ": how many there are", layout_why);
    unless(flown.unit == unit, at, what + ": its unit", meaning_why);
    unless(flown.enumeration == enumeration, at, what + ": its enumeration", meaning_why);
  }
  void fields(const std::vector<Field>& flown, const std::vector<Field>& fresh, const std::string& what,
              std::string_view why) {
    lists(
        flown, fresh, what + ": field ", its_name, [](const Field& each) { return each.at; }, why,
        [&](const Field& a, const Field& b) { field(a, b, what + ": field " + b.name); });
  }

 protected:
  TakenBy by_;
  std::vector<Obstacle> found_;
};

}  // namespace hirosco::descriptor::differences
