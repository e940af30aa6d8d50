// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include "hirosco/subsystem/cycle/reconfiguration.hpp"

namespace hirosco {
namespace {

[[nodiscard]] int member_of(const descriptor::ParameterRef& reference) noexcept {
  return reference.member ? static_cast<int>(*reference.member) : -1;
}

}  // namespace

Reconfiguration Reconfiguration::make(const descriptor::Configuration& from, const descriptor::Configuration& to,
                                      const descriptor::Bumpless& terms, const Dictionary& dictionary) {
  Reconfiguration made{.from = &from, .to = &to, .terms = &terms, .sampler = nullptr, .before = {}};
  for (const auto& initial : to.initial)
    made.before.emplace_back(dictionary.wire_octets(initial.parameter.parameter, member_of(initial.parameter)));
  return made;
}

Result<> Reconfiguration::set_values(Dictionary& dictionary) noexcept {
  for (std::size_t i = 0; i < before.size(); ++i) {
    const auto& [parameter, values] = to->initial[i];
    const int member = member_of(parameter);
    Result<> set = fail(ErrorCode::Mismatch, "an initial value");
    if (dictionary.encode(parameter.parameter, member, before[i]) == before[i].size())
      set = dictionary.set(parameter.parameter, member, values);
    if (set) continue;
    restore(dictionary, i);
    return set;
  }
  return ok();
}

/// Backwards: what was set twice has its first value again.
void Reconfiguration::restore(Dictionary& dictionary, std::size_t values) noexcept {
  for (std::size_t i = values; i > 0; --i) {
    const auto& parameter = to->initial[i - 1].parameter;
    static_cast<void>(dictionary.decode_into(parameter.parameter, member_of(parameter), before[i - 1]));
  }
}

}  // namespace hirosco
