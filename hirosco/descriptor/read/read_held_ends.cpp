// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "hirosco/descriptor/read/detail/device_reader.hpp"

/// What the supervisor's side holds of a device: second inhibits and power switches, their ways and the age of their answers (docs/adr/0237).
namespace hirosco::descriptor::detail {
namespace {

using std::chrono::milliseconds;

/// Three steps of the guard: an answer takes one, and a late step is no loss.
constexpr std::int64_t least_silence_ms = 15;
constexpr std::int64_t greatest_silence_ms = 1'000;
constexpr milliseconds silence_reduced{80};

}  // namespace

void DeviceReader::read_enable(const xml::Element& element, Device& device) {
  Attributes attributes{element, problems_};
  device.enable = read_address(attributes, problems_);  // its frames are little endian, always
  device.enable_terms = read_held_terms(attributes, *device.enable);
  device.enable_terms.goes_on = attributes.yes("goes_on", false);
  if (device.enable_terms.goes_on) check_goes_on(element, device.enable_terms);
  if (!device.actuator)
    problems_.add(element, "E0223", fmt::format("'{}' is no actuator: there is nothing to enable", device.name),
                  "actuator=\"yes\"");
}

void DeviceReader::read_power(const xml::Element& element, const std::string& device) {
  Attributes attributes{element, problems_};
  Endnode endnode = read_address(attributes, problems_);
  HeldTerms terms = read_held_terms(attributes, endnode);
  subsystem_.power_switches.push_back({device, std::move(endnode), place(element.at), std::move(terms)});
}

HeldTerms DeviceReader::read_held_terms(Attributes& attributes, const Endnode& preferred) {
  const xml::Element& element = attributes.element();
  HeldTerms terms;
  terms.silence =
      milliseconds{attributes.integer_or<std::int64_t>("silence_ms", least_silence_ms, greatest_silence_ms, 0)};
  const std::int64_t reduced =
      attributes.integer_or<std::int64_t>("silence_reduced_ms", least_silence_ms, greatest_silence_ms, 0);
  const bool limited = element.find("silence_ms") != nullptr;
  if (limited)
    terms.silence_reduced = reduced != 0 ? milliseconds{reduced} : std::max<Duration>(silence_reduced, terms.silence);
  if (!limited && element.find("silence_reduced_ms") != nullptr)
    problems_.add(*element.find("silence_reduced_ms"), "E0384",
                  "silence_reduced_ms is for answers that have an age limit",
                  "silence_ms says the limit with real-time scheduling");
  const auto read_fall_back = [&](const xml::Element& child) {
    Attributes own{child, problems_};
    no_children(child, problems_);
    Endnode found = read_address(own, problems_);
    const auto same = [&](const Endnode& other) {
      return other.transfer == found.transfer && other.address == found.address;
    };
    if (!found.address.empty() && (same(preferred) || std::ranges::any_of(terms.fall_backs, same)))
      problems_.add(found.at, "E0222", fmt::format("{} is tried already", in_quotes(found.address)),
                    "a fall-back has an address of its own");
    terms.fall_backs.push_back(std::move(found));
  };
  each_child(element, problems_, {{"FallBack", read_fall_back, max_fall_backs}});
  if (!terms.fall_backs.empty() && !limited)
    problems_.add(element, "E0381", fmt::format("<{}> has fall-backs, and no answer is ever too old", element.name),
                  "silence_ms, the age from which the endnode before counts as lost");
  return terms;
}

/// The device lets go by itself when it hears nothing, and takes nothing by another way then.
void DeviceReader::check_goes_on(const xml::Element& element, const HeldTerms& terms) {
  if (terms.fall_backs.empty())
    return problems_.add(*element.find("goes_on"), "E0382", "there is no way by which it could go on",
                         "add a <FallBack>, or leave it out");
  if (terms.silence == Duration{}) return;  // E0381
  if (terms.silence <= longest_silence_to_go_on && terms.silence_reduced <= longest_silence_to_go_on_reduced) return;
  const auto in_ms = [](Duration span) { return std::chrono::duration_cast<milliseconds>(span).count(); };
  problems_.add(*element.find("goes_on"), "E0383",
                fmt::format("after {} ms ({} ms without real-time scheduling) the device has let go by itself",
                            in_ms(terms.silence), in_ms(terms.silence_reduced)),
                fmt::format("silence_ms of at most {}, silence_reduced_ms of at most {}; or goes_on=\"no\"",
                            in_ms(longest_silence_to_go_on), in_ms(longest_silence_to_go_on_reduced)));
}

}  // namespace hirosco::descriptor::detail
