// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/model/model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "ground/model/json.hpp"
#include "hirosco/parameter/number.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "hirosco/utilities/crc32.hpp"

namespace hirosco::ground {
namespace {

/// Of a link, when its consumer cannot tell (supervisor.xml).
constexpr double not_told = std::numeric_limits<std::uint32_t>::max();
/// The columns of LINK_LATENCY, by bins.
constexpr std::array<const char*, LatencyHistogram::bins> latency_columns{
    "LINK_LATENCY.IN_1_64", "LINK_LATENCY.IN_1_32", "LINK_LATENCY.IN_1_16",
    "LINK_LATENCY.IN_1_8",  "LINK_LATENCY.IN_1_4",  "LINK_LATENCY.IN_1_2",
    "LINK_LATENCY.IN_1",    "LINK_LATENCY.IN_2",    "LINK_LATENCY.BEYOND"};
constexpr std::size_t longest_text = 2000;
/// Packets of one flight come nearly in order of time. Further back, the on-board clock has been set or began again.
constexpr Duration latest_packet = 5s;

/// Stages of ST[01] by subtype.
constexpr std::array<std::string_view, 11> stages{"",         "accepted",  "failed", "started", "failed", "progress",
                                                  "progress", "completed", "failed", "",        "failed"};

/// Failures are called by the names of the descriptors, with the words of whoever refused.
[[nodiscard]] std::optional<Verdict> verdict_of(const pus::PacketDescriber& describer,
                                                const pus::TelemetryView& packet) {
  const std::uint8_t subtype = packet.subtype();
  if (subtype == 0 || subtype >= stages.size() || stages[subtype].empty()) return std::nullopt;
  OctetReader reader{packet.source_data()};
  Verdict verdict;
  verdict.destination = packet.destination();
  verdict.request_id = reader.get<std::uint32_t>();
  verdict.stage = stages[subtype];
  if (subtype == 5 || subtype == 6) verdict.reason = "step " + std::to_string(reader.get<std::uint16_t>());
  const bool failure = subtype % 2 == 0;
  if (failure) {
    const auto code = reader.get<std::uint16_t>();
    verdict.code = code;
    if (!verdict.reason.empty()) verdict.reason += ": ";
    const std::string text = describer.describe_failure(packet.apid(), code, reader.rest());
    verdict.reason += text.empty() ? "code " + std::to_string(code) : text;
  }
  verdict.last = subtype == 7 || (failure && subtype != 6);
  return reader.good() ? std::optional{std::move(verdict)} : std::nullopt;
}

/// What is behind the event that a subsystem flies by another text of its descriptor; empty: the station has read that one, or cannot tell. What
/// is new has no names here: columns, forms and replays are made once, of what was read at the start (docs/adr/0214).
[[nodiscard]] std::string unread_text(const Catalogue& catalogue, Octets of_event) {
  OctetReader reader{of_event};
  const auto apid = reader.get<std::uint16_t>();
  const auto hash = reader.get<std::uint32_t>();
  const auto* subsystem = reader.good() ? catalogue.find(apid) : nullptr;
  if (subsystem == nullptr || !subsystem->text || crc32(std::as_bytes(std::span{*subsystem->text})) == hash) return {};
  return " by another text than this station has read of " + subsystem->name +
         ": what is new has names in one that is started now (hirosco ground --archive FILE)";
}

}  // namespace

Model::Model(const Catalogue& catalogue)
    : catalogue_{catalogue},
      describer_{catalogue.mission()},
      values_(catalogue.columns().size()),
      subsystems_(catalogue.subsystems().size()),
      links_(catalogue.mission().links.size()) {
  const auto column = [&](const char* name) { return catalogue_.supervisor_column(name); };
  subsystem_rows_ = catalogue_.supervisor_rows("SUBSYSTEMS.APID");
  link_rows_ = catalogue_.supervisor_rows("LINK_STATUS.LINK");
  overview_.mode = column("MODE");
  overview_.apid = column("SUBSYSTEMS.APID");
  overview_.state = column("SUBSYSTEMS.STATE");
  overview_.configuration = column("SUBSYSTEMS.CONFIGURATION");
  overview_.inhibited = column("SUBSYSTEMS.INHIBITED");
  overview_.cycles = column("SUBSYSTEMS.CYCLES");
  overview_.overruns = column("SUBSYSTEMS.OVERRUNS");
  overview_.missed = column("SUBSYSTEMS.MISSED");
  overview_.latency = column("SUBSYSTEMS.LATENCY_MAX");
  overview_.execution = column("SUBSYSTEMS.EXECUTION_MEAN");
  overview_.memory = column("SUBSYSTEMS.MEMORY");
  overview_.link = column("LINK_STATUS.LINK");
  overview_.up = column("LINK_STATUS.IS_UP");
  overview_.samples = column("LINK_STATUS.SAMPLES");
  overview_.age = column("LINK_STATUS.AGE");
  overview_.lost = column("LINK_STATUS.LOST");
  overview_.link_latency_mean = column("LINK_STATUS.LATENCY_MEAN");
  overview_.link_latency_max = column("LINK_STATUS.LATENCY_MAX");
  overview_.jitter = column("LINK_QUALITY.JITTER");
  overview_.age_at_use = column("LINK_QUALITY.AGE_AT_USE");
  latency_rows_ = catalogue_.supervisor_rows("LINK_LATENCY.LINK");
  overview_.latency_link = column("LINK_LATENCY.LINK");
  overview_.latency_period = column("LINK_LATENCY.PERIOD");
  std::ranges::transform(latency_columns, overview_.latency_bins.begin(), column);
}

Heard Model::take(const pus::TelemetryView& packet) {
  Heard heard;
  ++revision_;
  if (newest_ - packet.time() > latest_packet) set_back(packet.time());
  newest_ = std::max(newest_, packet.time());
  if (packet.service() == 1) heard.verdict = verdict_of(describer_, packet);
  if (packet.service() == 3 && packet.subtype() == 25) take_housekeeping(packet, heard);
  if (packet.service() == 5 && packet.subtype() >= 1 && packet.subtype() <= 4) take_event(packet, heard);
  const bool supervision =
      packet.service() == pus::st129::service_type && packet.apid() == catalogue_.mission().supervisor.id;
  if (supervision && packet.subtype() == pus::st129::permission_answer) {
    OctetReader reader{packet.source_data()};
    PermissionAnswer answer{.destination = packet.destination(), .request_id = reader.get<std::uint32_t>()};
    answer.permitted = reader.get<std::uint8_t>() == 1;
    answer.code = reader.get<std::uint16_t>();
    if (reader.good()) heard.answer = answer;
  }
  if (supervision && packet.subtype() == pus::st129::mode_preview) {
    if (auto preview = pus::st129::read_mode_preview(packet.source_data()))
      heard.mode_answer = ModeAnswer{.destination = packet.destination(), .preview = std::move(*preview)};
  }
  if (supervision && packet.subtype() == pus::st129::telecommand_copy)
    heard.telecommand.assign(packet.source_data().begin(), packet.source_data().end());
  if (!heard.changes.empty()) status_revision_ = revision_;
  return heard;
}

void Model::set_back(OnboardTime t) {
  const auto forget = [t](OnboardTime& told) {
    if (told > t) told = {};
  };
  for (Value& value : values_) {
    if (value.t <= t) continue;
    value.t = {};
    value.revision = revision_;
  }
  for (SubsystemView& view : subsystems_) {
    forget(view.state_at);
    forget(view.t);
  }
  forget(overview_at_);
  newest_ = t;
  status_revision_ = revision_;
}

void Model::take_housekeeping(const pus::TelemetryView& packet, Heard& heard) {
  OctetReader reader{packet.source_data()};
  heard.sid = reader.get<std::uint16_t>();
  const Report* report = catalogue_.report_of(packet.apid(), packet.source_data());
  if (report == nullptr) return;
  for (const Place& place : report->places) {
    Value& value = values_[place.column];
    if (value.revision != 0 && value.t > packet.time()) continue;
    value = {catalogue_.read(place, packet.source_data()), packet.time(), revision_,
             catalogue_.words(place, packet.source_data())};
  }
  const bool overview = packet.apid() == catalogue_.mission().supervisor.id && overview_.apid &&
                        report->places.size() > 1 &&
                        std::ranges::find(report->places, *overview_.apid, &Place::column) != report->places.end();
  if (overview) take_overview(packet.time(), heard);
  if (overview_.mode && values_[*overview_.mode].revision == revision_) {
    const auto& modes = catalogue_.mission().modes;
    const auto mode = std::ranges::find_if(
        modes, [&](const auto& known) { return static_cast<double>(known.id) == values_[*overview_.mode].number; });
    const std::string name = mode != modes.end() ? mode->name : "";
    if (name != mode_) heard.changes.push_back({packet.time(), "mode", "", name});
    mode_ = name;
  }
}

double Model::told(const std::optional<std::size_t>& column, std::size_t i) const {
  return column ? values_[*column + i].number : 0.0;
}

std::optional<LatencyHistogram> Model::latencies_of(std::uint8_t link, std::size_t row) const {
  if (row >= latency_rows_ || told(overview_.latency_link, row) != link) return std::nullopt;
  LatencyHistogram found{.period_ns = told(overview_.latency_period, row)};
  if (found.period_ns == 0.0) return std::nullopt;
  for (std::size_t bin = 0; bin < found.counts.size(); ++bin)
    found.counts[bin] = told(overview_.latency_bins[bin], row);
  return found;
}

void Model::take_overview(OnboardTime t, Heard& heard) {
  for (std::size_t i = 0; i < subsystem_rows_; ++i) {
    const auto apid = static_cast<std::uint16_t>(told(overview_.apid, i));
    const auto found = std::ranges::find(catalogue_.subsystems(), apid, &descriptor::SubsystemDescriptor::id);
    if (apid == 0 || found == catalogue_.subsystems().end()) continue;
    const auto place = static_cast<std::size_t>(found - catalogue_.subsystems().begin());
    SubsystemView& view = subsystems_[place];
    const auto count = [&](const auto& column) { return static_cast<std::uint32_t>(told(column, i)); };
    view.known = true;
    view.t = t;
    view.configuration = static_cast<std::uint8_t>(count(overview_.configuration));
    view.inhibited = count(overview_.inhibited);
    view.cycles = count(overview_.cycles);
    view.overruns = count(overview_.overruns);
    view.missed = count(overview_.missed);
    view.latency_max_ns = count(overview_.latency);
    view.execution_mean_ns = count(overview_.execution);
    view.memory_kb = count(overview_.memory);
    const auto state = static_cast<std::uint8_t>(count(overview_.state));
    const bool runs = state <= static_cast<std::uint8_t>(descriptor::State::SoftwareDeinit);
    take_state(place, runs ? std::optional{static_cast<descriptor::State>(state)} : std::nullopt, t, heard);
  }
  take_links(t, t - overview_at_, heard);
  overview_at_ = t;
  status_revision_ = revision_;
}

void Model::take_links(OnboardTime t, Duration since, Heard& heard) {
  const auto& links = catalogue_.mission().links;
  for (std::size_t i = 0; i < link_rows_; ++i) {
    const auto id = static_cast<std::uint8_t>(told(overview_.link, i));
    const auto found = std::ranges::find(links, id, &descriptor::MissionLink::id);
    if (id == 0 || found == links.end()) continue;
    LinkView& view = links_[static_cast<std::size_t>(found - links.begin())];
    const bool up = told(overview_.up, i) != 0.0;
    std::optional<std::uint32_t> samples;
    if (const double number = told(overview_.samples, i); number != not_told)
      samples = static_cast<std::uint32_t>(number);
    if (!view.known || view.up != up) heard.changes.push_back({t, "link", std::to_string(id), up ? "up" : "down"});
    view.rate_hz.reset();
    view.age_cycles.reset();
    const bool counted = samples && view.samples && *samples >= *view.samples;
    if (counted && up && view.up && since > Duration{0} && since < std::chrono::seconds{5})
      view.rate_hz = static_cast<double>(*samples - *view.samples) / seconds(since);
    const auto* consumer = catalogue_.find(found->to);
    const auto place = std::ranges::find(catalogue_.subsystems(), consumer) - catalogue_.subsystems().begin();
    const auto* configuration =
        consumer != nullptr ? consumer->find_configuration(subsystems_[static_cast<std::size_t>(place)].configuration)
                            : nullptr;
    if (up && samples.value_or(0) != 0 && configuration != nullptr && configuration->sampling > Duration{0})
      view.age_cycles = told(overview_.age, i) * 1e-6 / seconds(configuration->sampling);
    const auto by_consumer = [&](const auto& column) {
      const double number = told(column, i);
      return number == not_told ? std::nullopt : std::optional{number};
    };
    view.lost = by_consumer(overview_.lost);
    view.latency_mean_ns = by_consumer(overview_.link_latency_mean);
    view.latency_max_ns = by_consumer(overview_.link_latency_max);
    view.jitter_ns = by_consumer(overview_.jitter);
    view.age_at_use_us = by_consumer(overview_.age_at_use);
    view.latencies = latencies_of(id, i);
    view.known = true;
    view.up = up;
    view.samples = samples;
  }
}

void Model::take_state(std::size_t subsystem, std::optional<descriptor::State> state, OnboardTime t, Heard& heard) {
  SubsystemView& view = subsystems_[subsystem];
  if (t < view.state_at) return;
  const bool first = view.state_at == OnboardTime{};
  if (first || view.state != state)
    heard.changes.push_back(
        {t, "state", catalogue_.subsystems()[subsystem]->name, state ? std::string{to_text(*state)} : std::string{}});
  view.state = state;
  view.state_at = t;
}

void Model::take_event(const pus::TelemetryView& packet, Heard& heard) {
  OctetReader reader{packet.source_data()};
  StoredEvent event;
  event.t = packet.time();
  event.apid = packet.apid();
  event.subsystem = catalogue_.name_of(packet.apid());
  event.id = reader.get<std::uint16_t>();
  event.severity = packet.subtype();
  event.name = std::to_string(event.id);
  if (!reader.good()) return;
  nlohmann::json values = nlohmann::json::object();
  const auto found = std::ranges::find(catalogue_.subsystems(), packet.apid(), &descriptor::SubsystemDescriptor::id);
  const bool known = found != catalogue_.subsystems().end();
  const auto described = known ? std::ranges::find((*found)->events, event.id, &descriptor::Event::id)
                               : std::vector<descriptor::Event>::const_iterator{};
  if (known && described != (*found)->events.end()) {
    event.name = described->name;
    for (const auto& argument : described->arguments) {
      if (argument.text) {
        values[argument.name] = pus::text_of(reader.get(argument.octets()));
        continue;
      }
      for (std::uint16_t i = 0; i < argument.count; ++i) {
        const double number = get_number(reader, argument.type);
        if (!reader.good()) break;
        values[argument.count == 1 ? argument.name : argument.name + "[" + std::to_string(i) + "]"] =
            json_number(number);
        if (described->name == "STATE_CHANGED" && argument.name == "STATE" && number >= 0 &&
            number <= static_cast<double>(descriptor::State::SoftwareDeinit))
          take_state(static_cast<std::size_t>(found - catalogue_.subsystems().begin()),
                     static_cast<descriptor::State>(number), packet.time(), heard);
      }
    }
  }
  event.text = describer_.describe_event(packet.apid(), packet.source_data()).substr(0, longest_text);
  if (packet.apid() == pus::supervisor_apid && event.name == "DESCRIPTOR_TAKEN")
    event.text += unread_text(catalogue_, packet.source_data().subspan(sizeof event.id));
  event.values = to_string(values);
  heard.event = std::move(event);
}

std::string Model::waits_for(std::size_t subsystem) const {
  const auto& view = subsystems_[subsystem];
  const auto& descriptor = *catalogue_.subsystems()[subsystem];
  if (!view.state || view.state != descriptor::State::PreOperational) return {};
  const auto* configuration = descriptor.find_configuration(view.configuration);
  if (configuration == nullptr) return "a configuration";
  std::string waits;
  const auto& links = catalogue_.mission().links;
  for (const auto& wanted : configuration->requires_) {
    if (!wanted.required) continue;
    const auto link = std::ranges::find_if(
        links, [&](const auto& known) { return known.to == descriptor.name && known.requires_ == wanted.name; });
    const bool up = link != links.end() && links_[static_cast<std::size_t>(link - links.begin())].up;
    if (up) continue;
    waits += waits.empty() ? "" : ", ";
    waits += link != links.end() ? "link " + std::to_string(link->id) + " from " + link->from + "." + link->provides
                                 : "a link into " + wanted.name;
  }
  return waits;
}

}  // namespace hirosco::ground
