// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "hirosco/descriptor/framework_events.hpp"
#include "hirosco/subsystem/generic_subsystem.hpp"

/// How an author introduces its parts in Software-Init, compared with the descriptor: every difference is collected, so
/// that one look tells all of them.
namespace hirosco {
namespace {

/// Smallest and largest number that the descriptor permits.
[[nodiscard]] TypeRange permitted(const pus::Argument& declared) {
  TypeRange range = range_of(declared.field.type);
  if (!declared.texts.empty()) {
    const auto [lowest, highest] = std::ranges::minmax(declared.texts, {}, &descriptor::EnumerationText::value);
    range = {lowest.value, highest.value};
  }
  return {std::max(range.lowest, declared.field.minimum.value_or(range.lowest)),
          std::min(range.highest, declared.field.maximum.value_or(range.highest))};
}

/// Whether a C++ type takes every number that the descriptor permits, as it is.
[[nodiscard]] bool holds_numbers(Type native, const pus::Argument& declared) {
  const Type type = declared.field.type;
  if (type == Type::Text) return false;
  const TypeRange wanted = permitted(declared);
  if (is_integer(native)) {
    const TypeRange held = range_of(native);
    return is_integer(type) && held.lowest <= wanted.lowest && wanted.highest <= held.highest;
  }
  if (!is_integer(type)) return native == Type::Double || type == Type::Float;
  const Number exact = std::int64_t{1} << (native == Type::Double ? std::numeric_limits<double>::digits
                                                                  : std::numeric_limits<float>::digits);
  return Number{-exact.real()} <= wanted.lowest && wanted.highest <= exact;
}

[[nodiscard]] bool holds(const NativeField& native, const pus::Argument& declared) {
  const descriptor::Field& field = declared.field;
  if (native.type == Type::Text || field.type == Type::Text) return native.type == field.type;
  return native.takes(native.type, field.count) && holds_numbers(native.type, declared);
}

[[nodiscard]] std::string text_of(const pus::Argument& declared) {
  if (declared.field.type == Type::Text) return "TEXT of " + std::to_string(declared.field.text_octets) + " octets";
  return descriptor_text(declared.field.type, declared.field.count);
}

/// "3 (double, bool, std::array<float, 2>)"
template <class List>
[[nodiscard]] std::string listed(const List& list, std::string (*text)(const typename List::value_type&)) {
  std::string all;
  for (const auto& one : list) all.append(all.empty() ? " (" : ", ").append(text(one));
  return std::to_string(list.size()) + all + (all.empty() ? "" : ")");
}

}  // namespace

void GenericSubsystem::mistake(std::string problem) {
  // A software_init() that needs several rounds may say the same again.
  if (std::ranges::find(problems_, problem) == problems_.end()) problems_.push_back(std::move(problem));
}

void GenericSubsystem::provide(CustomService& service) {
  if (std::ranges::find(own_services_, &service) != own_services_.end()) return;
  service.join(*this);
  own_services_.push_back(&service);
  services_.push_back(&service);
}

void GenericSubsystem::bind_function(std::string_view name, BoundHandler handler) {
  const auto& functions = descriptor_.functions;
  const auto found = std::ranges::find(functions, name, &descriptor::Function::name);
  if (found == functions.end())
    return mistake("on_function: the descriptor declares no function '" + std::string{name} + "'");
  const std::vector<pus::Argument>& declared = found->arguments;
  std::vector<NativeField> natives;
  if (takes) natives.assign(takes->begin(), takes->end());
  else
    for (const auto& argument : declared) natives.push_back({Type::Double, argument.field.count});
  if (natives.size() != declared.size())
    return mistake(who + "the handler takes " + listed(natives, cpp_text) + ", the descriptor declares " +
                   listed(declared, text_of));
  for (std::size_t i = 0; i < declared.size(); ++i)
    if (!holds(natives[i], declared[i]))
      mistake(who + "argument " + std::to_string(i + 1) + ", " + declared[i].field.name + ": the descriptor declares " +
              text_of(declared[i]) + ", " + pus::range_text(declared[i]) + "; the handler takes " +
              (takes ? "" : "FunctionValues, ") + cpp_text(natives[i]) + ", which does not hold every value");
  if (!takes && pus::value_count(*found) > max_function_arguments)
    mistake(who + "FunctionValues hold " + std::to_string(max_function_arguments) +
            " numbers, the descriptor declares " + std::to_string(pus::value_count(*found)));
  cycle_.functions()[static_cast<std::size_t>(found - functions.begin())].handler = std::move(handler);
}

void GenericSubsystem::publish(std::string_view name, ParameterCell& parameter) {
  if (const auto published = dictionary_.publish(name, parameter); !published) mistake(published.error());
}

void GenericSubsystem::use_event(EventPort& event) {
  const descriptor::Event* declared = descriptor_.find_event(event.name());
  if (declared == nullptr)
    return mistake("use_event: the descriptor declares no event '" + std::string{event.name()} + "'");
  const bool same = std::ranges::equal(event.arguments(), declared->arguments, [](const NativeField& n, const auto& d) {
    return n.type == d.type && n.count == d.count;
  });
  used_events_.push_back(declared->id);
  if (same) return event.bind(declared->id);
  std::string native, wanted;
  for (const auto& field : event.arguments()) native.append(native.empty() ? "" : ", ").append(cpp_text(field));
  for (const auto& field : declared->arguments)
    wanted.append(wanted.empty() ? "" : ", ").append(descriptor_text(field.type, field.count));
  mistake("use_event " + std::string{event.name()} + ": its arguments are (" + native + "), the descriptor declares (" +
          wanted + ")");
}

void GenericSubsystem::use_request(const RequestPort& request, RequestHandler handler, Duration patience) {
  if (std::string problem = requester_.use(request, std::move(handler), patience); !problem.empty())
    mistake(std::move(problem));
}

void GenericSubsystem::require_link(std::string_view set, LinkInputPort& port) {
  const auto sets = descriptor::required_sets(descriptor_);
  if (std::ranges::find(sets, set) == sets.end())
    mistake("require_link: no configuration requires a set '" + std::string{set} + "'");
  link_ports_[std::string{set}] = &port;
}

void GenericSubsystem::use_device(std::string_view name, DevicePortBase& port) {
  const auto& devices = descriptor_.devices;
  if (std::ranges::find(devices, name, &descriptor::Device::name) == devices.end())
    mistake("use_device: the descriptor declares no device '" + std::string{name} + "'");
  device_ports_[std::string{name}] = &port;
}

/// What is missing when the author has said all.
void GenericSubsystem::check_introduction() {
  if (!dictionary_problem_.empty()) mistake(dictionary_problem_);
  std::string missing;
  if (!dictionary_.all_published(missing)) mistake("parameters declared but not published: " + missing);
  for (std::size_t i = 0; i < descriptor_.functions.size(); ++i)
    if (!cycle_.functions()[i].handler)
      mistake("function declared but without a handler: " + descriptor_.functions[i].name);
  for (const auto& event : descriptor_.events)
    if (event.id < descriptor::framework_event::first && !uses_all_events_ &&
        std::ranges::find(used_events_, event.id) == used_events_.end())
      mistake("event declared but never used: " + event.name);
  for (const CustomService* service : own_services_)
    for (std::string& problem : service->problems()) mistake(std::move(problem));
  for (const auto& declared : descriptor_.services)
    if (std::ranges::count(own_services_, declared.name, &CustomService::name) != 1)
      mistake("service declared but not provided once: " + declared.name);
}

void GenericSubsystem::forget_introduction() {
  requester_.forget();  // first: who waits may still end what it was asked itself
  dictionary_.unpublish_all();
  for (CustomService* service : own_services_) service->release();
  used_events_.clear();
  link_ports_.clear();
  device_ports_.clear();
  cycle_.functions().assign(descriptor_.functions.size(), {});
}

}  // namespace hirosco
