// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/clients/yamcs/yamcs_project.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "ground/clients/xtce/xtce.hpp"
#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/utilities/utf8.hpp"

namespace hirosco::ground {
namespace {

constexpr std::string_view licence = R"(# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
)";

constexpr const char* pom = R"(<?xml version="1.0" encoding="UTF-8"?>
<!-- SPDX-FileCopyrightText: 2026 The HIROSCO developers -->
<!-- SPDX-License-Identifier: Apache-2.0 -->
<project xmlns="http://maven.apache.org/POM/4.0.0">
  <modelVersion>4.0.0</modelVersion>
  <groupId>local.hirosco</groupId>
  <artifactId>yamcs-server</artifactId>
  <version>1</version>
  <packaging>pom</packaging>
  <properties><yamcs.version>5.13.2</yamcs.version></properties>
  <dependencies>
    <dependency><groupId>org.yamcs</groupId><artifactId>yamcs-core</artifactId><version>${yamcs.version}</version></dependency>
    <dependency><groupId>org.yamcs</groupId><artifactId>yamcs-web</artifactId><version>${yamcs.version}</version></dependency>
  </dependencies>
</project>
)";

constexpr std::string_view processor = R"(realtime:
  services:
    - class: org.yamcs.StreamTmPacketProvider
    - class: org.yamcs.StreamTcCommandReleaser
    - class: org.yamcs.tctm.StreamParameterProvider
    # runs the verifiers of commands, too
    - class: org.yamcs.algorithms.AlgorithmManager
    - class: org.yamcs.parameter.LocalParameterManager
  config:
    generateEvents: true
    subscribeAll: true
    alarm: {parameterCheck: true, parameterServer: enabled, eventServer: enabled}
    tmProcessor: {ignoreOutOfContainerEntries: false}
Archive:
  services:
    - class: org.yamcs.tctm.ReplayService
    - class: org.yamcs.algorithms.AlgorithmManager
ParameterArchive:
  services:
    - class: org.yamcs.tctm.ReplayService
    - class: org.yamcs.algorithms.AlgorithmManager
ArchiveRetrieval:
  services:
    - class: org.yamcs.tctm.ReplayService
    - class: org.yamcs.algorithms.AlgorithmManager
)";

/// Of the server: {instance}, {mission}.
constexpr const char* server = R"(services:
  - class: org.yamcs.http.HttpServer
    args: {{address: 127.0.0.1, port: 8090}}
instances:
  - {instance}
dataDir: yamcs-data
# Signs what browsers keep; whoever lets others than this computer in has another one.
secretKey: loopback-only
serverId: hirosco
buckets:
  - name: stacks
    path: stacks
yamcs-web:
  tag: {mission}
)";

/// Of the instance: {event_id}, {name}, {most}, {supervisor} and hosts and ports of telemetry and telecommands.
constexpr const char* instance = R"(services:
  - class: org.yamcs.archive.XtceTmRecorder
  - class: org.yamcs.archive.ParameterRecorder
  - class: org.yamcs.archive.AlarmRecorder
  - class: org.yamcs.archive.EventRecorder
  - class: org.yamcs.archive.ReplayServer
  - class: org.yamcs.archive.CommandHistoryRecorder
  - class: org.yamcs.parameterarchive.ParameterArchive
    args:
      # 5.13.2: with it the history of a whole array is answered by an error
      realtimeFiller: {{enabled: false}}
      backFiller: {{enabled: false}}
  - class: org.yamcs.ProcessorCreatorService
    args: {{name: realtime, type: realtime}}
  - class: org.yamcs.pus.PusEventDecoder
    args:
      eventIdParameter: {event_id}
      eventTemplateFile: etc/events.json

dataLinks:
  - name: tm
    class: org.yamcs.tctm.TcpTmDataLink
    stream: tm_realtime
    host: {tm_host}
    port: {tm_port}
    # Without the class its arguments are ignored.
    packetInputStreamClassName: org.yamcs.tctm.CcsdsPacketInputStream
    packetInputStreamArgs: {{maxPacketLength: {most}}}
    packetPreprocessorClassName: org.yamcs.pus.PusPacketPreprocessor
    packetPreprocessorArgs:
      errorDetection: {{type: CRC-16-CCIIT}}
      timeEncoding: {{type: CUC, epoch: TAI, implicitPField: 31}}
  - name: tc
    class: org.yamcs.tctm.TcpTcDataLink
    stream: tc_realtime
    host: {tc_host}
    port: {tc_port}
    # Fills in sequence count, length and CRC.
    commandPostprocessorClassName: org.yamcs.pus.PusCommandPostprocessor
    commandPostprocessorArgs:
      errorDetection: {{type: CRC-16-CCIIT}}
      timeEncoding: {{pfield: 31, implicitPfield: true}}
      pus11Apid: {supervisor}

mdb:
  - type: xtce
    args: {{file: mdb/{name}.xml}}

streamConfig:
  tm:
    - {{name: tm_realtime, processor: realtime}}
  invalidTm: invalid_tm_stream
  cmdHist: [cmdhist_realtime]
  event: [events_realtime]
  param: [pp_realtime, sys_param, proc_param]
  parameterAlarm: [alarms_realtime]
  eventAlarm: [event_alarms_realtime]
  tc:
    - {{name: tc_realtime, processor: realtime}}
)";

constexpr const char* read_me = R"(<!-- SPDX-FileCopyrightText: 2026 The HIROSCO developers -->
<!-- SPDX-License-Identifier: Apache-2.0 -->
# {mission} in Yamcs

From the mission's descriptors, by `hirosco export yamcs`: export again rather than change it. It wants Java 17 or later; Yamcs
(AGPL-3.0) comes from its own publisher:

    mvn dependency:copy-dependencies -DoutputDirectory=lib
    mkdir -p yamcs-data
    java -Xmx256m -cp 'lib/*' org.yamcs.YamcsServer --etc-dir etc --data-dir yamcs-data

Fly first (`hirosco run`), or wait 10 s: Yamcs asks for the flight's ports, {telemetry} and {telecommand}, as often as that. Its page is at
port 8090 of this computer alone. `--check` in front of the folders reads all of it, without a flight, and ends.

| file | what |
|---|---|
| `mdb/{name}.xml` | XTCE 1.2: each report and request of every subsystem |
| `etc/events.json` | what the events say |
| `stacks/*.ycs` | stacks: each brings the craft into a mode, waits until it is there, and asks all who are alive |

Reports to this database's own source id, {source}, verify its commands; those to other ground stations do not.
)";

/// Keys stay in the order in which they were given. What words of a mission stand in it are printable.
using Json = nlohmann::ordered_json;
[[nodiscard]] std::string lines_of(const Json& json) { return json.dump(2) + "\n"; }

struct Address {
  std::string host, port;
};
[[nodiscard]] Address address_of(const std::string& text) {
  const auto colon = std::min(text.rfind(':'), text.size());
  return {text.substr(0, colon), text.substr(std::min(colon + 1, text.size()))};
}

/// What stands between braces would be a parameter.
[[nodiscard]] std::string template_text(std::string text) {
  std::erase_if(text, [](char c) { return c == '{' || c == '}'; });
  return text;
}

[[nodiscard]] Json events_of(const Catalogue& catalogue, const Xtce& database) {
  Json events = Json::array();
  for (std::size_t i = 0; i < catalogue.subsystems().size(); ++i) {
    const auto& subsystem = *catalogue.subsystems()[i];
    for (const auto& event : subsystem.events) {
      std::string text = template_text(subsystem.name + " " + event.name);
      if (const auto arguments = database.arguments[i].find(event.id); arguments != database.arguments[i].end())
        for (const EventArgument& argument : arguments->second)
          text += fmt::format(" {}={{{}}}{}", template_text(argument.name), argument.path,
                              argument.unit.empty() ? "" : " " + template_text(argument.unit));
      events.push_back({{"eventId", printable_words(fmt::format("{}-{}", database.events.at(event.id), subsystem.id))},
                        {"template", printable_words(text)}});
    }
  }
  return events;
}

[[nodiscard]] Json command_step(const std::string& name, Json arguments) {
  return {{"type", "command"}, {"name", printable_words(name)}, {"arguments", std::move(arguments)}};
}

/// Into a mode, and whether all are alive there. Empty: the supervisor cannot be asked for it.
[[nodiscard]] std::string stack_of(const Catalogue& catalogue, const Xtce& database, const descriptor::Mode& mode) {
  const auto& supervisor = catalogue.mission().supervisor;
  const auto set_mode = database.commands.front().find("SET_MODE");
  if (set_mode == database.commands.front().end() || supervisor.find_parameter("MODE") == nullptr) return {};
  constexpr int longest_ms = 80'000;
  const Json argument{{"name", "MODE"}, {"value", printable_words(mode.name)}};
  // Of another type than its argument: a plain number.
  const Json condition{
      {"parameter", printable_words("/" + database.name + "/" + XtceNames{}.unique(supervisor.name) + "/MODE")},
      {"operator", "eq"},
      {"value", mode.id}};
  Json steps = Json::array();
  steps.push_back(command_step(set_mode->second, Json::array({argument})));
  steps.push_back({{"type", "verify"}, {"timeout", longest_ms}, {"condition", Json::array({condition})}});
  for (const CommandPaths& commands : database.commands)
    if (const auto ping = commands.find("PING"); ping != commands.end())
      steps.push_back(command_step(ping->second, Json::array()));
  return lines_of({{"$schema", "https://yamcs.org/schema/stack.schema.json"},
                   {"advancement", {{"acknowledgment", "Verifier_Complete"}, {"wait", 0}}},
                   {"steps", std::move(steps)}});
}

}  // namespace

YamcsProject yamcs_project(const Catalogue& catalogue) {
  const auto& mission = catalogue.mission();
  const Xtce database = xtce(catalogue);
  std::string name = database.name;
  std::ranges::transform(name, name.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  const Address telemetry = address_of(mission.ground.telemetry), telecommand = address_of(mission.ground.telecommand);
  YamcsProject project{.name = name + "-yamcs", .files = {}};
  auto& files = project.files;
  files["mdb/" + database.name + ".xml"] = database.text;
  files["pom.xml"] = pom;
  files["etc/processor.yaml"] = std::string{licence} + std::string{processor};
  files["etc/events.json"] = lines_of(events_of(catalogue, database));
  files["etc/yamcs.yaml"] =
      std::string{licence} + fmt::format(server, fmt::arg("instance", name),
                                         fmt::arg("mission", Json(printable_words("HIROSCO " + mission.name)).dump()));
  files["etc/yamcs." + name + ".yaml"] =
      std::string{licence} + fmt::format(instance, fmt::arg("event_id", database.event_id),
                                         fmt::arg("name", database.name), fmt::arg("most", pus::max_telemetry_octets),
                                         fmt::arg("supervisor", mission.supervisor.id),
                                         fmt::arg("tm_host", telemetry.host), fmt::arg("tm_port", telemetry.port),
                                         fmt::arg("tc_host", telecommand.host), fmt::arg("tc_port", telecommand.port));
  files["README.md"] =
      fmt::format(read_me, fmt::arg("mission", printable_words(mission.name)), fmt::arg("instance", name),
                  fmt::arg("name", database.name), fmt::arg("source", exported_source),
                  fmt::arg("telemetry", mission.ground.telemetry), fmt::arg("telecommand", mission.ground.telecommand));
  XtceNames stacks;
  for (const auto& mode : mission.modes)
    if (std::string stack = stack_of(catalogue, database, mode); !stack.empty()) {
      const bool start = mode.name == mission.start_mode;
      files["stacks/" + stacks.unique((start ? "commission_" : "mode_") + mode.name) + ".ycs"] = std::move(stack);
    }
  return project;
}

}  // namespace hirosco::ground
