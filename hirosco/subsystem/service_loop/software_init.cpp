// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/subsystem/cycle/layout_difference.hpp"
#include "hirosco/subsystem/service_loop/generic_subsystem.hpp"

/// How an author introduces its parts in Software-Init, compared with the descriptor: every difference is collected, so
/// that one look tells all of them.
namespace hirosco {
void GenericSubsystem::mistake(std::string problem, std::optional<descriptor::Location> at) {
  // A software_init() that needs several rounds may say the same again.
  Mistake made{std::move(problem), at};
  if (std::ranges::find(problems_, made) == problems_.end()) problems_.push_back(std::move(made));
}

std::string GenericSubsystem::words_of(const Mistake& mistake) const {
  if (!mistake.at) return mistake.text;
  return descriptor_.file.string() + ":" + std::to_string(mistake.at->line) + ":" + std::to_string(mistake.at->column) +
         ": error: E0405: " + mistake.text;
}

/// What ground has room for: the reason before the length of a path.
std::string GenericSubsystem::short_words_of(const Mistake& mistake) const {
  if (!mistake.at) return mistake.text;
  return descriptor_.file.filename().string() + ":" + std::to_string(mistake.at->line) + ":" +
         std::to_string(mistake.at->column) + ": " + mistake.text;
}

std::vector<Mistake> GenericSubsystem::try_introduction() {
  constexpr int most_rounds = 1'000;
  Result<Step> step = again;
  for (int round = 0; round < most_rounds && step && *step == Step::Again; ++round) step = initialise_software();
  if (!step && problems_.empty()) mistake(step.error().text);
  forget_introduction();
  return std::exchange(problems_, {});
}

void GenericSubsystem::provide(CustomService& service) {
  if (std::ranges::find(own_services_, &service) != own_services_.end()) return;
  const auto* declared = descriptor_.find_service(service.name());
  OwnLoop* const loop = declared != nullptr ? loop_of(declared->type) : nullptr;
  service.join(loop != nullptr ? static_cast<pus::ServiceHome&>(*loop) : *this);
  if (loop != nullptr) loop->host(service);
  own_services_.push_back(&service);
  services_.push_back(&service);
}

void GenericSubsystem::bind_function(std::string_view name, BoundHandler handler) {
  const auto& functions = descriptor_.functions;
  const auto found = std::ranges::find(functions, name, &descriptor::Function::name);
  if (found == functions.end())
    return mistake("on_function: the descriptor declares no function '" + std::string{name} + "'");
  for (std::string& problem :
       handler_mistakes("on_function " + std::string{name} + ": ", handler.takes, found->arguments))
    mistake(std::move(problem));
  cycle_.functions()[static_cast<std::size_t>(found - functions.begin())].handler = std::move(handler.call);
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

void GenericSubsystem::use_subscription(SubscriptionPort& heard) {
  if (std::string problem = subscriber_.use(heard); !problem.empty()) mistake(std::move(problem));
}

void GenericSubsystem::require_link(std::string_view set, LinkInputPort& port) {
  const auto sets = descriptor::required_sets(descriptor_);
  if (std::ranges::find(sets, set) == sets.end())
    mistake("require_link: no configuration requires a set '" + std::string{set} + "'");
  for (const auto& configuration : descriptor_.configurations)
    for (const descriptor::Requires& wanted : configuration.requires_) {
      if (wanted.name != set || !wanted.terms.lent() || !port.lent()) continue;
      if (const auto difference = layout_difference(port.layout(), wanted.fields); !difference.empty())
        mistake("require_link " + wanted.name + ": " + difference);
    }
  link_ports_[std::string{set}] = &port;
}

void GenericSubsystem::lend_link(std::string_view set, LoanOutputPort& port) {
  bool known = false;
  for (const auto& configuration : descriptor_.configurations)
    for (const descriptor::Provides& lent : configuration.provides) {
      if (lent.name != set || !lent.terms.lent()) continue;
      known = true;
      if (const auto difference = layout_difference(port.layout(), lent.fields); !difference.empty())
        mistake("lend_link " + lent.name + ": " + difference);
    }
  if (!known) mistake("lend_link: no configuration lends a set '" + std::string{set} + "'");
  lent_ports_[std::string{set}] = &port;
}

void GenericSubsystem::use_device(std::string_view name, DevicePortBase& port,
                                  std::span<const std::string_view> settings) {
  const auto& devices = descriptor_.devices;
  if (std::ranges::find(devices, name, &descriptor::Device::name) == devices.end())
    mistake("use_device: the descriptor declares no device '" + std::string{name} + "'");
  port.will_read(settings);
  device_ports_[std::string{name}] = &port;
}

/// What a configuration gives and no code reads: in all of them, so that none has to be flown for it.
void GenericSubsystem::check_settings() {
  for (const auto& configuration : descriptor_.configurations)
    for (const auto& use : configuration.devices) {
      const std::string& device = descriptor_.devices[use.device].name;
      const auto port = device_ports_.find(device);
      for (const descriptor::Setting& setting : use.settings)
        if (port == device_ports_.end() || !port->second->reads(setting.name))
          mistake("nobody reads setting '" + setting.name + "' of '" + device + "'", setting.at);
      if (use.endnode.framing == Framing::Raw && port != device_ports_.end() && port->second->protocol() == nullptr)
        mistake("device '" + device + "' is reached with framing=\"raw\", and its port does not speak() a protocol");
    }
}

/// What is missing when the author has said all.
void GenericSubsystem::check_introduction() {
  if (!dictionary_problem_.empty()) mistake(dictionary_problem_);
  if (!resources_.problem().empty()) mistake(resources_.problem());
  std::string missing;
  if (!dictionary_.all_published(missing)) mistake("parameters declared but not published: " + missing);
  for (std::size_t i = 0; i < descriptor_.functions.size(); ++i)
    if (!cycle_.functions()[i].handler)
      mistake("function declared but without a handler: " + descriptor_.functions[i].name);
  for (const auto& event : descriptor_.events)
    if (event.id < descriptor::framework_event::first && !uses_all_events_ &&
        std::ranges::find(used_events_, event.id) == used_events_.end())
      mistake("event declared but never used: " + event.name);
  for (const auto& configuration : descriptor_.configurations)
    for (const descriptor::Provides& lent : configuration.provides)
      if (lent.terms.lent() && !lent_ports_.contains(lent.name))
        mistake("set lent but without a place to make it, lend_link: " + lent.name);
  if (std::string problem = foreign_.use(subscriber_); !problem.empty()) mistake(std::move(problem));
  check_settings();
  for (const CustomService* service : own_services_)
    for (std::string& problem : service->problems()) mistake(std::move(problem));
  for (const auto& declared : descriptor_.services)
    if (std::ranges::count(own_services_, declared.name, &CustomService::name) != 1)
      mistake("service declared but not provided once: " + declared.name);
}

void GenericSubsystem::forget_introduction() {
  subscriber_.forget();
  foreign_.forget();
  requester_.forget();  // first: who waits may still end what it was asked itself
  const LoopsAtRest at_rest{loops_};
  dictionary_.unpublish_all();
  for (CustomService* service : own_services_) service->release();
  used_events_.clear();
  link_ports_.clear();
  lent_ports_.clear();
  device_ports_.clear();
  cycle_.functions().assign(descriptor_.functions.size(), {});
}

}  // namespace hirosco
