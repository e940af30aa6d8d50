// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/introduction.hpp"

#include <algorithm>
#include <utility>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/descriptor/model/framework_parameters.hpp"

namespace hirosco {

void Introduction::mistake(Mistake made) {
  // A software_init() that needs several rounds may say the same again, and so may configurations of one device.
  if (std::ranges::find(mistakes_, made) == mistakes_.end()) mistakes_.push_back(std::move(made));
}

std::string Introduction::words_of(const Mistake& mistake) const {
  const std::string said = mistake.text + (mistake.remedy.empty() ? "" : "; " + mistake.remedy);
  if (!mistake.at) return said;
  return parts_.descriptor.file.string() + ":" + std::to_string(mistake.at->line) + ":" +
         std::to_string(mistake.at->column) + ": error: " + mistake.code + ": " + said;
}

/// What ground has room for: the reason before the length of a path.
std::string Introduction::short_words_of(const Mistake& mistake) const {
  if (!mistake.at) return mistake.text;
  return parts_.descriptor.file.filename().string() + ":" + std::to_string(mistake.at->line) + ":" +
         std::to_string(mistake.at->column) + ": " + mistake.text;
}

Result<Step> Introduction::step() {
  if (const auto taken = parts_.resources.take_pools(); !taken) {
    mistake(taken.error().text);
    return fail(taken.error());
  }
  begun_ = true;
  pools_told_ = false;
  const LoopsAtRest at_rest{parts_.loops.all()};
  const auto step = parts_.author.software_init();
  if (step && *step == Step::Again) return again;
  if (!step) mistake(step.error().text);
  publish(descriptor::framework_parameter::cycle_stats, parts_.cycle.statistics());
  publish(descriptor::framework_parameter::cycle_times, parts_.cycle.times());
  publish(descriptor::framework_parameter::cycle_budget, parts_.cycle.budget());
  publish(descriptor::framework_parameter::cycle_spin, parts_.cycle.spin());
  publish(descriptor::framework_parameter::link_stats, parts_.cycle.link_statistics());
  publish(descriptor::framework_parameter::loop_stats, parts_.cycle.loop_statistics());
  publish(descriptor::framework_parameter::resource_stats, parts_.cycle.resource_statistics());
  publish(descriptor::framework_parameter::heap_uses, parts_.cycle.heap_uses());
  publish(descriptor::framework_parameter::descriptor, parts_.descriptor_in_force);
  for (const auto& output : parts_.cycle.outputs()) publish(output->name(), *output);
  if (step) check();
  if (!mistakes_.empty()) {
    text_ = short_words_of(mistakes_.front());
    const Error said =
        step ? Error{ErrorCode::Mismatch, "", static_cast<std::int64_t>(mistakes_.size())} : step.error();
    return fail(said.code, text_.c_str(), said.value);
  }
  HIROSCO_TRY(parts_.values.initialise());
  parts_.foreign.begin(parts_.values.dictionary());
  return done;
}

std::vector<Mistake> Introduction::try_all() {
  constexpr int most_rounds = 1'000;
  Result<Step> step = again;
  for (int round = 0; round < most_rounds && step && *step == Step::Again; ++round) step = this->step();
  if (!step && mistakes_.empty()) mistake(step.error().text);
  // What software_init() took goes back, for its pools end here.
  Result<Step> undone = again;
  for (int round = 0; round < most_rounds && undone && *undone == Step::Again; ++round) undone = undo(true);
  if (!undone) mistake(undone.error().text);
  if (const auto late = undo_late(); !late) mistake(late.error().text);
  return std::exchange(mistakes_, {});
}

Result<Step> Introduction::undo(bool cycle_rests) {
  if (begun_) {
    HIROSCO_TRY_LET(const Step step, parts_.author.software_deinit());
    if (step == Step::Again) return again;
  }
  if (!cycle_rests) return done;
  forget();
  HIROSCO_TRY(give_pools_back());
  return done;
}

Result<> Introduction::undo_late() {
  // What the author named may lie in his pools: nobody looks at it any more when they go.
  if (begun_) forget();
  return give_pools_back();
}

Result<> Introduction::give_pools_back() {
  auto given = parts_.resources.give_pools_back();
  if (!given && std::exchange(pools_told_, true)) return ok();
  return given;
}

void Introduction::provide(CustomService& service) {
  if (std::ranges::find(own_services_, &service) != own_services_.end()) return;
  const auto* declared = parts_.descriptor.find_service(service.name());
  OwnLoop* const loop = declared != nullptr ? parts_.loops.of(declared->type) : nullptr;
  service.join(loop != nullptr ? static_cast<pus::ServiceHome&>(*loop) : parts_.home);
  if (loop != nullptr) loop->host(service);
  own_services_.push_back(&service);
  parts_.services.add(service);
}

void Introduction::bind_function(std::string_view name, BoundHandler handler) {
  const auto& functions = parts_.descriptor.functions;
  const auto found = std::ranges::find(functions, name, &descriptor::Function::name);
  if (found == functions.end())
    return mistake("on_function: the descriptor declares no function '" + std::string{name} + "'");
  for (std::string& problem :
       handler_mistakes("on_function " + std::string{name} + ": ", handler.takes, found->arguments))
    mistake(std::move(problem));
  parts_.cycle.functions()[static_cast<std::size_t>(found - functions.begin())] = std::move(handler.call);
}

void Introduction::publish(std::string_view name, ParameterCell& parameter) {
  if (const auto published = parts_.values.dictionary().publish(name, parameter); !published)
    mistake(published.error());
}

void Introduction::use_event(EventPort& event) {
  const descriptor::Event* declared = parts_.descriptor.find_event(event.name());
  if (declared == nullptr)
    return mistake("use_event: the descriptor declares no event '" + std::string{event.name()} + "'");
  const bool same = std::ranges::equal(event.arguments(), declared->arguments, [](const NativeField& n, const auto& d) {
    return n.type == (d.text ? Type::Text : d.type) && n.count == d.count;
  });
  used_events_.push_back(declared->id);
  if (same) return event.bind(declared->id);
  std::string native, wanted;
  for (const auto& field : event.arguments()) native.append(native.empty() ? "" : ", ").append(cpp_text(field));
  for (const auto& field : declared->arguments)
    wanted.append(wanted.empty() ? "" : ", ")
        .append(descriptor_text(field.text ? Type::Text : field.type, field.count));
  mistake("use_event " + std::string{event.name()} + ": its arguments are (" + native + "), the descriptor declares (" +
          wanted + ")");
}

void Introduction::use_request(const RequestPort& request, RequestHandler handler, Duration patience) {
  if (std::string problem = parts_.requester.use(request, std::move(handler), patience); !problem.empty())
    mistake(std::move(problem));
}

void Introduction::use_subscription(SubscriptionPort& heard) {
  if (std::string problem = parts_.subscriber.use(heard); !problem.empty()) mistake(std::move(problem));
}

void Introduction::require_link(std::string_view set, LinkInputPort& port) {
  const auto sets = descriptor::required_sets(parts_.descriptor);
  if (std::ranges::find(sets, set) == sets.end())
    mistake("require_link: no configuration requires a set '" + std::string{set} + "'");
  parts_.ports.require_link(set, port);
}

void Introduction::lend_link(std::string_view set, LoanOutputPort& port) {
  const bool known = std::ranges::any_of(parts_.descriptor.configurations, [&](const auto& configuration) {
    return std::ranges::any_of(configuration.provides, [&](const descriptor::Provides& provided) {
      return provided.name == set && provided.terms.lent();
    });
  });
  if (!known) mistake("lend_link: no configuration lends a set '" + std::string{set} + "'");
  parts_.ports.lend_link(set, port);
}

void Introduction::use_device(std::string_view name, DevicePortBase& port, std::span<const std::string_view> settings) {
  const auto& devices = parts_.descriptor.devices;
  if (std::ranges::find(devices, name, &descriptor::Device::name) == devices.end())
    mistake("use_device: the descriptor declares no device '" + std::string{name} + "'");
  port.will_read(settings);
  parts_.ports.use_device(name, port);
}

/// What is missing when the author has said all.
void Introduction::check() {
  if (!parts_.values.problem().empty()) mistake(parts_.values.problem());
  std::string missing;
  if (!parts_.values.dictionary().all_published(missing)) mistake("parameters declared but not published: " + missing);
  for (std::size_t i = 0; i < parts_.descriptor.functions.size(); ++i)
    if (!parts_.cycle.functions()[i])
      mistake("function declared but without a handler: " + parts_.descriptor.functions[i].name);
  for (const auto& event : parts_.descriptor.events)
    if (event.id < descriptor::framework_event::first && !uses_all_events_ &&
        std::ranges::find(used_events_, event.id) == used_events_.end())
      mistake("event declared but never used: " + event.name);
  // Of all configurations, so that none has to be flown for it: the one that is commanded when something has failed, too (adr 0189).
  for (const auto& configuration : parts_.descriptor.configurations)
    for (Mistake& made : parts_.ports.mistakes(configuration)) mistake(std::move(made));
  if (std::string problem = parts_.foreign.use(parts_.subscriber); !problem.empty()) mistake(std::move(problem));
  for (const CustomService* service : own_services_)
    for (std::string& problem : service->problems()) mistake(std::move(problem));
  for (const auto& declared : parts_.descriptor.services)
    if (std::ranges::count(own_services_, declared.name, &CustomService::name) != 1)
      mistake("service declared but not provided once: " + declared.name);
}

void Introduction::forget() {
  begun_ = false;
  parts_.subscriber.forget();
  parts_.foreign.forget();
  // Before their services are released: who waits may still end what it was asked itself.
  parts_.requester.forget();
  const LoopsAtRest at_rest{parts_.loops.all()};
  // A step of a loop may have had a block for as long as it lasted. None is under way now, and none takes one any more.
  parts_.resources.pools().close();
  parts_.values.dictionary().unpublish_all();
  for (CustomService* service : own_services_) service->release();
  used_events_.clear();
  parts_.ports.forget();
  parts_.cycle.functions().assign(parts_.descriptor.functions.size(), {});
}

}  // namespace hirosco
