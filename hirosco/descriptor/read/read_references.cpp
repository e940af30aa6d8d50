// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <utility>

#include "hirosco/descriptor/read/detail/references.hpp"

namespace hirosco::descriptor::detail {

/// A parameter's own name goes before members of that name: it is listed first, and is not ambiguous.
void References::index(std::size_t own) {
  own_ = own;
  const auto add = [this](const std::string& text, std::size_t parameter, std::optional<std::uint16_t> member) {
    references_[text].push_back({text, static_cast<std::uint16_t>(parameter), member, {}});
  };
  const auto& parameters = subsystem_.parameters;
  for (std::size_t i = 0; i < parameters.size(); ++i) add(parameters[i].field.name, i, std::nullopt);
  for (std::size_t i = 0; i < parameters.size(); ++i)
    for (std::uint16_t m = 0; m < parameters[i].numbers(); ++m) {
      const std::string member{parameters[i].identity_of(m).name};
      if (i < own) add(member, i, m);
      add(parameters[i].field.name + "." + member, i, m);
    }
}

std::optional<ParameterRef> References::resolve(const xml::Attribute& name, std::string_view user) {
  const std::string_view text = name.value;
  const auto found = text.empty() ? references_.end() : references_.find(text);
  if (found == references_.end()) {
    problems_.add(name, "E0204", fmt::format("{} refers to {}, which is not defined", user, in_quotes(text)),
                  suggest_reference(text));
    return std::nullopt;
  }
  const std::vector<ParameterRef>& members = found->second;
  if (members.size() == 1 || !members.front().member) {
    ParameterRef reference = members.front();
    reference.at = place(name.value_at);
    return reference;
  }
  std::string hint = "one of";
  for (std::size_t i = 0; i < members.size() && i < 8; ++i)
    hint += fmt::format(" '{}.{}'", subsystem_.parameters[members[i].parameter].field.name, text);
  problems_.add(name, "E0205", fmt::format("{} refers to {}, a member of several structures", user, in_quotes(text)),
                hint);
  return std::nullopt;
}

std::string References::suggest_reference(std::string_view text) const {
  std::vector<std::string_view> names;
  for (const auto& [name, references] : references_) names.push_back(name);
  std::string hint = did_you_mean(text, names);
  const std::size_t first = hint.find('\''), last = hint.rfind('\'');
  if (hint.empty() || first == last) return hint;
  const ParameterRef& nearest = references_.find(hint.substr(first + 1, last - first - 1))->second.front();
  const Parameter& parameter = subsystem_.parameters[nearest.parameter];
  const Field& field = nearest.member ? parameter.members_at(nearest.member).front().field : parameter.field;
  return hint + fmt::format(" (line {})", field.at.line);
}

std::size_t References::octets_of(const ParameterRef& reference) const {
  const Parameter& parameter = subsystem_.parameters[reference.parameter];
  return parameter.octets(reference.member);
}

void References::read_sampled(const xml::Element& element, std::vector<ParameterRef>& into, std::string_view user) {
  each_child(element, problems_, {{"ParamRef", [&](const xml::Element& child) {
                                     Attributes attributes{child, problems_};
                                     no_children(child, problems_);
                                     if (auto reference = read_reference(attributes, user))
                                       into.push_back(std::move(*reference));
                                   }}});
  if (element.children.empty())
    problems_.add(element, "E0106", fmt::format("<{}> needs at least one <ParamRef>", element.name));
}

std::optional<ParameterRef> References::read_reference(Attributes& attributes, std::string_view user) {
  const auto* name = attributes.required("name");
  return name == nullptr ? std::nullopt : resolve(*name, user);
}

}  // namespace hirosco::descriptor::detail
