// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <charconv>
#include <utility>

#include "hirosco/descriptor/read/detail/subsystem_reader.hpp"
#include "hirosco/descriptor/read/read.hpp"

namespace hirosco::descriptor {
namespace detail {
namespace {

constexpr std::size_t max_description = 4096;
/// Each has its own copy of what the subsystem declares for all of them.
constexpr std::size_t max_configurations = 64;
constexpr std::size_t max_name_octets = 64;
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
      {"Resources", [this](const auto& element) { read_resources(element); }, 1},
      {"Parameters", later(parameters), 1},
      {"StructRef", later(parameters)},
      {"ParamRef", later(parameters)},
      {"Enumeration", [this](const auto& element) { read_enumeration(element); }},
      {"Device", [this](const auto& element) { read_device(element); }, 255},
      {"Hang", [this](const auto& element) { read_hang(element); }, 1},
      {"Commands", [this](const auto& element) { read_commands(element); }, 255},
      {"Subscribes", [this](const auto& element) { read_subscribes(element); }, 255},
      {"Script", [this](const auto& element) { read_script(element); }, max_scripts},
      {"Failure", [this](const auto& element) { read_failure(element); }, 1024},
      {"CustomService", later(custom_services), max_custom_services},
      {"ServiceLoop", [this](const auto& element) { read_service_loop(element); }, max_service_loops},
      {"Service", later(uses), 255},
      {"Bumpless", later(bumpless), max_configurations},
      {"Configuration", later(configurations), max_configurations}};
  Services services{subsystem_.housekeeping, provides_, requires_, structure_ids_, provided_, required_,
                    self_test_within_};
  const std::vector<Child> service_rows = service_children(services);
  for (const Child& row : service_rows) children.push_back({row.name, later(services_elements), row.most});
  each_child(root, problems_, children);
  imply_outputs();
  for (const xml::Element* element : parameters) read_parameter_element(*element);
  read_initial_values();
  imply_parameters();
  configurations_ = configurations.size();
  for (const xml::Element* element : services_elements)
    std::ranges::find(service_rows, element->name, &Child::name)->read(*element);
  for (const xml::Element* element : custom_services) read_custom_service(*element);
  for (const xml::Element* element : uses) read_service(*element, subsystem_.service_uses, service_uses_, false);
  for (const xml::Element* element : configurations) read_configuration(*element);
  for (const xml::Element* element : bumpless) read_bumpless(*element);
  check_service_list(root);
  check_foreign();
  imply_framework_events();
  check_enumerations();
  check_addresses();
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

void SubsystemReader::read_device(const xml::Element& element) {
  Attributes attributes{element, problems_};
  const std::string name = attributes.name("name", NameKind::Loose);
  const auto add_name = [&] {
    if (!name.empty()) device_names_.add(name, place(element.at), problems_, element.name.size() + 1);
  };
  const bool several = std::ranges::find(element.children, "Endnode", &xml::Element::name) != element.children.end();
  if (!several) {
    Device device;
    device.name = name;
    read_frames(attributes, std::move(device));
    return add_name();
  }
  add_name();
  const auto read_one = [&](const xml::Element& child) {
    Attributes own{child, problems_};
    Device device;
    device.part_of = name;
    device.name = name + "." + own.name();
    if (device.name.size() > max_name_octets)
      problems_.add(
          child, "E0114", fmt::format("'{}' is too long", device.name),
          fmt::format("name of device and endnode have at most {} characters, with the dot", max_name_octets));
    device_names_.add(device.name, place(child.at), problems_, child.name.size() + 1);
    read_frames(own, std::move(device));
  };
  each_child(
      element, problems_,
      {{"Endnode", read_one, max_device_endnodes}, {"Power", [&](const auto& power) { read_power(power, name); }, 1}});
}

void SubsystemReader::read_power(const xml::Element& element, const std::string& device) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  subsystem_.power_switches.push_back({device, read_address(attributes), place(element.at)});
}

/// What a device, or an endnode of one that has several, exchanges.
void SubsystemReader::read_frames(Attributes& attributes, Device device) {
  const xml::Element& element = attributes.element();
  device.at = place(element.at);
  device.actuator = attributes.yes("actuator", false);
  read_stop(attributes, device);
  Unique inputs{"input field", "E0201"}, outputs{"output field", "E0201"};
  std::vector<Child> known{
      {"Input",
       [&](const xml::Element& input) {
         const Attributes none{input, problems_};
         each_child(input, problems_,
                    {{"Field", [&](const auto& field) { read_plain_field(field, device.input, inputs); }}});
       },
       1},
      {"Output",
       [&](const xml::Element& output) {
         const Attributes none{output, problems_};
         each_child(output, problems_, {{"Field", [&](const auto& field) { read_output(field, device, outputs); }}});
       },
       1},
      {"Enable", [&](const auto& enable) { read_enable(enable, device); }, 1}};
  // Power is a whole device's.
  if (device.part_of.empty()) known.push_back({"Power", [&](const auto& power) { read_power(power, device.name); }, 1});
  each_child(element, problems_, known);
  if (device.input.empty() && device.output.empty())
    problems_.add(element, "E0106", fmt::format("<{}> needs a <Field> of <Input> or <Output>", element.name));
  check_octets(element, device);
  if (device.actuator && device.output.empty())
    problems_.add(element, "E0106", "an actuator needs an <Output> with at least one <Field>");
  if (device.actuator && !device.enable)
    problems_.warn(device.at, "E0403", fmt::format("actuator '{}' has no second inhibit", device.name),
                   "only its subsystem keeps it from moving: add <Enable transfer=\"...\" address=\"...\"/>",
                   element.name.size() + 1);
  subsystem_.devices.push_back(std::move(device));
}

void SubsystemReader::read_stop(Attributes& attributes, Device& device) {
  device.stop = attributes.one_of("stop", StopKind::Drop);
  device.stop_within = std::chrono::milliseconds{attributes.integer_or<std::int64_t>("stop_within_ms", 1, 60'000, 0)};
  const xml::Element& element = attributes.element();
  const auto* within = attributes.optional("stop_within_ms");
  if (element.find("stop") != nullptr && device.stop == StopKind::Controlled && within == nullptr)
    problems_.add(element, "E0105", "<Device stop=\"controlled\"> needs the attribute 'stop_within_ms'",
                  "the time in which it comes to rest by itself");
  for (const std::string_view name : {"stop", "stop_within_ms"})
    if (element.find(name) != nullptr && !device.actuator)
      problems_.add(*element.find(name), "E0223",
                    fmt::format("'{}' is no actuator: it has nothing to stop", device.name), "actuator=\"yes\"");
}

void SubsystemReader::read_enable(const xml::Element& element, Device& device) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  device.enable = read_address(attributes);  // its frames are little endian, always
  if (!device.actuator)
    problems_.add(element, "E0223", fmt::format("'{}' is no actuator: there is nothing to enable", device.name),
                  "actuator=\"yes\"");
}

void SubsystemReader::check_octets(const xml::Element& element, const Device& device) {
  std::size_t input = 0, output = 0;
  for (const Field& field : device.input) input += field.octets();
  for (const Device::Output& out : device.output) output += out.field.octets();
  for (const auto& [direction, octets] : {std::pair{"input", input}, {"output", output}})
    if (octets > max_device_octets)
      problems_.add(element, "E0215",
                    fmt::format("the {} of device '{}' takes {} octets", direction, device.name, octets),
                    fmt::format("at most {}", max_device_octets));
}

void SubsystemReader::read_output(const xml::Element& element, Device& device, Unique& names) {
  Attributes attributes{element, problems_};
  Device::Output output;
  output.field = read_field(attributes, Says::Range);
  output.safe = read_numbers(problems_, attributes, "safe", output.field);
  no_children(element, problems_);
  if (device.actuator && element.find("safe") == nullptr)
    problems_.add(element, "E0218", fmt::format("output '{}' of an actuator needs its safe value", output.field.name),
                  "add the attribute safe: it is sent in every state but Operational");
  if (!output.field.name.empty()) names.add(output.field.name, place(element.at), problems_, element.name.size() + 1);
  device.output.push_back(std::move(output));
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
