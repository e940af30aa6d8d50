// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <utility>

#include "hirosco/descriptor/model/supervisor_apid.hpp"
#include "hirosco/descriptor/read/detail/subsystem_reader.hpp"
#include "hirosco/descriptor/read/read.hpp"

namespace hirosco::descriptor {
namespace detail {
namespace {

constexpr std::size_t max_description = 4096;
/// Each has its own copy of what the subsystem declares for all of them.
constexpr std::size_t max_configurations = 64;
constexpr std::size_t max_custom_services = 64;
constexpr std::size_t max_scripts = 64;

}  // namespace

SubsystemDescriptor SubsystemReader::read(const xml::Element& root) {
  read_head(root);
  std::vector<const xml::Element*> parameters, configurations, services_elements, custom_services, uses, bumpless;
  const auto later = [](std::vector<const xml::Element*>& list) {
    return [&list](const xml::Element& e) { list.push_back(&e); };
  };
  std::vector<Child> children{
      {"Description",
       [this](const xml::Element& element) {
         const Attributes none{element, problems_};
         no_children(element, problems_, true);
         if (element.text.size() > max_description)
           problems_.add(element, "E0114", "a description has at most 4096 octets");
         subsystem_.description = element.text;
       },
       1},
      {"Resources", [this](const auto& element) { read_resources(element, subsystem_.resources, problems_); }, 1},
      {"Parameters", later(parameters), 1},
      {"StructRef", later(parameters)},
      {"ParamRef", later(parameters)},
      {"Enumeration", [this](const auto& element) { parameters_.read_enumeration(element); }},
      {"Device", [this](const auto& element) { devices_.read(element); }, 255},
      {"Hang", [this](const auto& element) { read_hang(element); }, 1},
      {"Commands", [this](const auto& e) { read_commands(e, problems_, commanded_, subsystem_.commands); }, 255},
      {"Subscribes", [this](const auto& e) { read_subscribes(e, problems_, heard_, subsystem_.subscribes); }, 255},
      {"Script", [this](const auto& element) { read_script(element); }, max_scripts},
      {"Failure", [this](const auto& element) { read_failure(element); }, 1024},
      {"CustomService", later(custom_services), max_custom_services},
      {"ServiceLoop", [this](const auto& element) { service_list_.read_service_loop(element); }, max_service_loops},
      {"Service", later(uses), 255},
      {"Bumpless", later(bumpless), max_configurations},
      {"Configuration", later(configurations), max_configurations}};
  Services services{subsystem_.housekeeping, provides_, requires_, structure_ids_, provided_, required_,
                    self_test_within_};
  const std::vector<Child> service_rows = services_.children(services);
  for (const Child& row : service_rows) children.push_back({row.name, later(services_elements), row.most});
  each_child(root, problems_, children);
  built_in_.imply_outputs();
  for (const xml::Element* element : parameters) parameters_.read(*element);
  parameters_.read_initial_values();
  const std::size_t own = subsystem_.parameters.size();
  built_in_.imply_parameters();
  references_.index(own);
  for (const xml::Element* element : services_elements)
    std::ranges::find(service_rows, element->name, &Child::name)->read(*element);
  for (const xml::Element* element : custom_services) custom_services_.read(*element);
  Unique service_uses{"service", "E0201"};
  for (const xml::Element* element : uses)
    service_list_.read_service(*element, subsystem_.service_uses, service_uses, false);
  for (const xml::Element* element : configurations) configurations_.read(*element, services, configurations.size());
  for (const xml::Element* element : bumpless) bumpless_.read(*element);
  service_list_.check(root);
  parameters_.check_foreign();
  functions_.check_protections();
  events_.imply_framework_events();
  fields_.check_enumerations();
  check_enumerations_named(root, problems_);
  check_addresses(subsystem_, problems_);
  fit_queues(root, subsystem_, problems_);
  if (subsystem_.id == supervisor_apid) check_supervisor(root, problems_);
  return std::move(subsystem_);
}

void SubsystemReader::read_head(const xml::Element& root) {
  Attributes attributes{root, problems_};
  subsystem_.name = attributes.name();
  subsystem_.id = attributes.required_integer<std::uint16_t>("id", 1, 2039);
}

void SubsystemReader::read_failure(const xml::Element& element) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  FailureName failure;
  failure.name = attributes.name();
  if (!failure.name.empty()) failure_names_.add(failure.name, place(element.at), problems_, element.name.size() + 1);
  const auto* code = attributes.required("code");
  if (code == nullptr) return;
  std::string_view digits = code->value;
  const bool hexadecimal = digits.starts_with("0x");
  if (hexadecimal) digits.remove_prefix(2);
  unsigned number = 0;
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), number, hexadecimal ? 16 : 10);
  if (error != std::errc{} || end != digits.data() + digits.size())
    return problems_.add(*code, "E0111", in_quotes(code->value) + " is not a failure code", "for example 0x8001");
  if (number < 0x8000 || number > 0xFFFF)
    return problems_.add(*code, "E0112", "failure code " + code->value + " is out of range", "0x8000 to 0xFFFF");
  failure.code = static_cast<std::uint16_t>(number);
  failure_codes_.add(std::to_string(number), place(code->value_at), problems_, code->value.size());
  subsystem_.failures.push_back(std::move(failure));
}

/// What stands in it is looked at by who plays it, and by `hirosco check`.
void SubsystemReader::read_script(const xml::Element& element) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  ScriptFile script;
  script.name = attributes.name();
  script.at = place(element.at);
  if (!script.name.empty()) script_names_.add(script.name, script.at, problems_, element.name.size() + 1);
  const auto* file = attributes.required("file");
  if (file == nullptr) return;
  script.file = file->value;
  if (script.file.empty()) problems_.add(*file, "E0109", "attribute 'file' is empty");
  subsystem_.scripts.push_back(std::move(script));
}

void SubsystemReader::read_hang(const xml::Element& element) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  subsystem_.hang = read_limit(attributes, "realtime", "reduced", subsystem_.hang);
}

}  // namespace detail

Reading<SubsystemDescriptor> read_subsystem(const std::filesystem::path& file, const FileSource& source) {
  detail::Problems problems{file};
  std::shared_ptr<const std::string> text;
  const FileSource kept = [&](const std::filesystem::path& asked) {
    auto content = source(asked);
    if (content) text = std::make_shared<const std::string>(*content);
    return content;
  };
  const auto root = detail::read_root(file, kept, "Subsystem", problems);
  Reading<SubsystemDescriptor> reading;
  if (root) {
    SubsystemDescriptor subsystem = detail::SubsystemReader{problems}.read(*root);
    subsystem.file = file;
    subsystem.text = std::move(text);
    if (problems.count() == 0) reading.value = std::move(subsystem);
  }
  reading.problems = problems.take();
  reading.warnings = problems.take_warnings();
  return reading;
}

}  // namespace hirosco::descriptor
