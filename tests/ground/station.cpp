// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tests/ground/station.hpp"

#include <stdexcept>
#include <utility>

namespace hirosco::testing {

Station::Station(simulation::Flight& flight, const std::string& archive)
    : flight_{flight}, clock_{flight.craft()}, catalogue_{flight.mission()} {
  auto opened = ground::Archive::open(archive);
  if (!opened) throw std::runtime_error{opened.error().text};
  archive_ = std::move(*opened);
  ground::Surroundings outside;
  outside.send = [this](Octets packet, ground::Way) {
    if (linked_) flight_.craft().ground().send(packet);
    return linked_;
  };
  outside.ask_device = [this](const std::string& device, const std::string& line, const auto& done) {
    const auto result = inject(device, line);
    done(result ? std::string{"ok"} : std::string{result.error().text});
  };
  outside.injected = [this] { return std::exchange(injected_, {}); };
  session_ = std::make_unique<ground::Session>(ground::Session::Parts{
      .catalogue = catalogue_, .archive = *archive_, .clock = clock_, .outside = std::move(outside)});
  ground::Api::Options options;
  options.token = token;
  options.observer_token = "looker";
  options.page = "no/such/folder";
  api_ = std::make_unique<ground::Api>(*session_, options);
  join_link();
}

Result<> Station::inject(const std::string& device, const std::string& line) {
  auto done = flight_.craft().device(device)->fault(line);
  if (done) injected_.push_back({clock_.onboard(), device, line, "ok"});
  return done;
}

Station::~Station() { flight_.craft().ground().on_telemetry({}); }

void Station::join_link() {
  linked_ = true;
  session_->link_up();
  flight_.craft().ground().on_telemetry([this](Octets packet) { EXPECT_TRUE(session_->receive(packet)); });
}

void Station::cut_link() {
  linked_ = false;
  flight_.craft().ground().on_telemetry({});
  session_->link_down();
}

void Station::run(Duration span) {
  for (Duration done{0}; done < span; done += 50ms) {
    flight_.craft().run(std::min<Duration>(50ms, span - done));
    api_->tick();
  }
}

bool Station::run_until(const std::function<bool()>& condition, Duration limit) {
  for (Duration done{0}; done < limit && !condition(); done += 50ms) run(50ms);
  return condition();
}

ground::HttpResponse Station::ask(const std::string& method, const std::string& target, const json& body,
                                  std::map<std::string, std::string> headers) {
  headers.try_emplace("host", "127.0.0.1:8080");
  headers.try_emplace("authorization", std::string{"Bearer "} + token);
  std::optional<ground::HttpResponse> answer;
  api_->handle({method, target, headers, body.is_null() ? "" : body.dump()},
               [&](ground::HttpResponse response) { answer = std::move(response); });
  run_until([&] { return answer.has_value(); });
  return answer.value_or(ground::HttpResponse{.status = 0, .type = {}, .body = "{}", .headers = {}});
}

json Station::command(const std::string& subsystem, const std::string& function, const json& arguments) {
  json sent = post("/api/commands", {{"subsystem", subsystem}, {"function", function}, {"arguments", arguments}});
  if (!sent.contains("id")) return sent;
  json command;
  run_until([&] {
    command = get("/api/commands?limit=1")["commands"][0];
    return command["stage"] == "completed" || command["stage"] == "failed";
  });
  return command;
}

}  // namespace hirosco::testing
