// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/script_player/script_player.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hirosco/descriptor/model/setting_files.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/pus/requests.hpp"
#include "hirosco/pus/script/script.hpp"
#include "hirosco/subsystem/author/custom_service.hpp"
#include "hirosco/utilities/lower_case.hpp"
#include "subsystems/script_player/script_run.hpp"

namespace hirosco {
namespace {

using script_player::Progress;
using script_player::ScriptRun;

class ScriptPlayer final : public Subsystem, private script_player::Stage {
  // STATUS of script_player.xml: same members, same order.
  struct Status {
    Progress progress;
    std::uint16_t line;
    std::uint16_t done;
    std::uint16_t lines;
    float time_s;
    friend bool operator==(const Status&, const Status&) = default;
  };
  static constexpr std::size_t name_octets = 32, why_octets = 120;

  /// What a line of a script needs of the framework.
  struct Means {
    std::unique_ptr<OpenRequest> request;
    std::vector<std::optional<Value>> values;
    descriptor::Thing awaited;  ///< by an `until`
    std::unique_ptr<OpenSubscription> event;
    bool heard{false};
  };
  struct Part {
    pus::Script script;
    std::vector<Means> lines;
  };

  Result<> offline() override {
    scripts_.on_request("PLAY",
                        [this](std::string_view name, const Call& call) -> Outcome { return play(name, call); });
    scripts_.on_request("HOLD", [this]() -> Outcome {
      if (!run_.active()) return refused(Trouble::nothing_played);
      run_.hold();
      return ok();
    });
    scripts_.on_request("RESUME", [this]() -> Outcome {
      if (!run_.active()) return refused(Trouble::nothing_played);
      run_.resume();
      return ok();
    });
    scripts_.on_request("ABORT", [this]() -> Outcome {
      if (!run_.active()) return refused(Trouble::nothing_played);
      run_.stop(Progress::Aborted, "aborted in line " + std::to_string(run_.line()));
      tell_end();
      return ok();
    });
    provide(scripts_);
    return ok();
  }

  Result<Step> software_init() override {
    publish("STATUS", status_);
    publish("SCRIPT", name_);
    publish("WHY", why_);
    use_event(begun_);
    use_event(ended_);
    use_event(stopped_);
    played_ = nullptr;
    call_.reset();
    parts_.clear();
    run_ = {};
    shown_ = {};
    shown_name_ = std::string_view{};
    shown_why_ = std::string_view{};
    for (const descriptor::ScriptFile& file : own_descriptor().scripts) {
      HIROSCO_TRY(take(file));
    }
    return done;
  }

  /// Whole, or Software-Init fails with the first thing that is wrong.
  Result<> take(const descriptor::ScriptFile& file) {
    const auto text = descriptor::file_system()(descriptor::file_of(own_descriptor(), file.file));
    if (!text) return not_taken(file, 0, text.error().text);
    pus::ScriptReading reading = pus::read_script(file.name, *text);
    auto problems = std::move(reading.problems);
    if (problems.empty()) problems = pus::check_script(reading.script, own_descriptor());
    if (!problems.empty()) return not_taken(file, problems.front().line, problems.front().message);
    Part& part = parts_.emplace_back(std::move(reading.script), std::vector<Means>{});
    double longest_s = ScriptRun::usual_limit_s;
    for (const pus::ScriptLine& line : part.script.lines)
      if (line.kind == pus::ScriptLine::Kind::Limit) longest_s = std::max(longest_s, line.seconds);
    // The limit of the script comes first: what nobody ever ends does not stay open for ever.
    const Duration patience{static_cast<std::int64_t>((longest_s + 1) * 1e9)};
    part.lines.resize(part.script.lines.size());  // from here on they stay where they are
    for (std::size_t i = 0; i < part.lines.size(); ++i) bind(part.script.lines[i], part.lines[i], patience);
    return ok();
  }
  Result<> not_taken(const descriptor::ScriptFile& file, int line, std::string_view why) {
    problem_ = file.file + ":" + std::to_string(line) + ": " + std::string{why};
    return fail(ErrorCode::Malformed, problem_.c_str());
  }

  void bind(const pus::ScriptLine& line, Means& means, Duration patience) {
    using Kind = pus::ScriptLine::Kind;
    const auto hear = [this](const RequestReport& report) { run_.hear(report, now_, *this); };
    if (line.kind == Kind::Telecommand) {
      const auto request = pus::request_of(line, own_descriptor());
      means.values = pus::values_of(line, *request).value();
      const bool setting = request->name.starts_with(pus::setting_prefix);
      means.request =
          std::make_unique<OpenRequest>(subsystem_of(line), setting ? Ask::SetValue : Ask::Function,
                                        setting ? request->name.substr(pus::setting_prefix.size()) : request->name);
      use_request(*means.request, hear, patience);
    } else if (line.kind == Kind::Until) {
      means.awaited = **pus::awaited_by(line, own_descriptor());
      means.request = std::make_unique<OpenRequest>(subsystem_of(line), Ask::ReadValue, means.awaited.name);
      use_request(*means.request, hear);
    } else if (line.kind == Kind::Event) {
      const auto event = pus::awaited_by(line, own_descriptor());
      means.event =
          std::make_unique<OpenSubscription>(subsystem_of(line), SubscriptionPort::What::Event, (*event)->name);
      use_subscription(*means.event, [&means](Octets) { means.heard = true; });
    }
  }
  /// As its descriptor calls it.
  [[nodiscard]] std::string subsystem_of(const pus::ScriptLine& line) const {
    const auto same = [&](const std::string& name) { return lower_case(name) == lower_case(line.subsystem); };
    for (const auto& each : own_descriptor().commands)
      if (same(each.subsystem)) return each.subsystem;
    for (const auto& each : own_descriptor().subscribes)
      if (same(each.subsystem)) return each.subsystem;
    return line.subsystem;
  }

  Outcome play(std::string_view name, const Call& call) {
    if (run_.active()) return refused(Trouble::busy, "another script is played");
    const auto part = std::ranges::find_if(
        parts_, [&](const Part& each) { return lower_case(each.script.name) == lower_case(std::string{name}); });
    if (part == parts_.end())
      return refused(Trouble::no_such_script, "scripts there are", static_cast<std::int64_t>(parts_.size()));
    played_ = &*part;
    call_ = call;
    forget_events();
    run_.begin(played_->script, now_);
    raise_in_service(begun_, static_cast<std::uint16_t>(played_->script.lines.size()));
    return running;
  }

  void service(TimePoint now) override {
    now_ = now;
    if (run_.active() && state() != State::Operational)
      run_.stop(Progress::Failed, "line " + std::to_string(run_.line()) + ": its player has left Operational");
    run_.step(now, *this);
    tell_end();
    show();
  }

  /// Once, when it has come to one.
  void tell_end() {
    if (run_.active() || !call_) return;
    const Call call = *std::exchange(call_, std::nullopt);
    if (run_.progress() == Progress::Ended) {
      raise_in_service(ended_, static_cast<std::uint16_t>(run_.done()));
      scripts_.finish(call);
      return;
    }
    raise_in_service(stopped_, run_.line(), static_cast<std::uint8_t>(run_.progress()));
    scripts_.abort(call, {ErrorCode::NotPermitted, run_.why().c_str(), 0});
  }

  /// The cycle has it with its next boundary; what does not fit now comes with a later step.
  void show() {
    constexpr float tenth = 10;
    const Status status{run_.progress(), run_.line(), static_cast<std::uint16_t>(run_.done()),
                        static_cast<std::uint16_t>(played_ != nullptr ? played_->script.lines.size() : 0),
                        static_cast<float>(static_cast<int>(run_.time_s() * tenth)) / tenth};
    const bool cycles = state() == State::PreOperational || state() == State::SafeOperational ||
                        state() == State::Operational || state() == State::ErrorOperational;
    if (!cycles) return;
    show_one(name_, Text<name_octets>{played_ != nullptr ? played_->script.name : std::string_view{}}, shown_name_);
    show_one(why_, Text<why_octets>{run_.why()}, shown_why_);
    show_one(status_, status, shown_);
  }
  template <class T>
  void show_one(const Parameter<T>& parameter, const T& value, T& shown) {
    if (!(value == shown) && scripts_.store(parameter, value)) shown = value;
  }

  // --- Stage ----------------------------------------------------------------------------------------------------------
  Result<std::uint32_t> ask(std::size_t line) override {
    const Means& means = played_->lines[line];
    return request(*means.request, means.values);
  }
  std::optional<double> number_in(std::size_t line, Octets answered) override {
    constexpr std::size_t head_octets = 5;  // how many, and which
    if (answered.size() < head_octets) return std::nullopt;
    return pus::number_of(played_->lines[line].awaited, answered.subspan(head_octets));
  }
  bool was_heard(std::size_t line) override { return played_->lines[line].heard; }
  void forget_events() override {
    for (Means& means : played_->lines) means.heard = false;
  }

  enum class Trouble : std::uint16_t { no_such_script = 0x8001, busy = 0x8002, nothing_played = 0x8003 };

  CustomService scripts_{"SCRIPTS"};
  Parameter<Status> status_;
  Parameter<Text<name_octets>> name_;
  Parameter<Text<why_octets>> why_;
  Event<std::uint16_t> begun_{"SCRIPT_BEGUN"}, ended_{"SCRIPT_ENDED"};  ///< lines
  Event<std::uint16_t, std::uint8_t> stopped_{"SCRIPT_STOPPED"};  ///< line, how
  std::vector<Part> parts_;
  Part* played_{nullptr};
  std::optional<Call> call_;
  ScriptRun run_;
  Status shown_{};
  Text<name_octets> shown_name_;
  Text<why_octets> shown_why_;
  TimePoint now_{};
  std::string problem_;  ///< of Software-Init, in words
};

}  // namespace

std::unique_ptr<Subsystem> make_script_player() { return std::make_unique<ScriptPlayer>(); }

}  // namespace hirosco
