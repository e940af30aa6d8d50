// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "switch.hpp"

#include <atomic>
#include <hirosco/subsystem/author/custom_service.hpp>
#include <hirosco/subsystem/author/module.hpp>
#include <map>
#include <string>

namespace {

using namespace hirosco;

class Switch final : public Subsystem {
  struct Answers {  // ANSWERS in switch.xml
    std::uint32_t completed;
    std::uint32_t refused;
    std::uint32_t failed;
  };

  struct Seen {  // SEEN in switch.xml
    double brightness;
    std::uint32_t reports;
    std::uint32_t programs;
  };
  struct Lamp {  // structure 4800 of the lamp: its CUR_VALUES
    double brightness;
    double current_a;
  };

  Result<> offline() override {
    panel_.on_request("PRESS", [this](double brightness, const Call& call) -> Outcome {
      return ends_with(request(fade_, brightness), call);
    });
    panel_.on_request("CHANGE_MODE", [this](std::uint8_t mode, const Call& call) -> Outcome {
      return ends_with(request(set_mode_, mode), call);
    });
    provide(panel_);
    return ok();
  }
  /// Whoever pressed waits for the end of what is asked of another one.
  Outcome ends_with(const Result<std::uint32_t>& asked, const Call& call) {
    if (!asked) return Result<>{std::unexpected{asked.error()}};
    pressed_.emplace(*asked, call);
    return running;
  }
  Result<Step> software_init() override {
    publish("BLINK_S", blink_s_);
    publish("ANSWERS", answers_);
    publish("SEEN", seen_);
    publish("MODE", mode_);
    use_request(fade_, [this](const RequestReport& report) { hear(report); });
    use_request(look_, [](const RequestReport&) {});
    use_request(set_mode_, [this](const RequestReport& report) { hear(report); });
    use_subscription(lamp_, [this](const Lamp& lamp) {
      brightness_.store(lamp.brightness);
      ++reports_;
    });
    use_subscription(programmed_, [this](std::uint64_t, std::uint8_t, std::uint8_t, std::array<float, 3>) {
      ++programs_;
      static_cast<void>(request(look_));  // at once, and not only with the next period
    });
    return done;
  }

  /// What comes of a request: in the service loop, where it was asked.
  void hear(const RequestReport& report) {
    if (!report.is_end()) return;
    using Stage = RequestReport::Stage;
    const bool completed = report.stage == Stage::Completed;
    ++(completed ? completed_ : report.stage == Stage::Refused ? refused_ : failed_);
    const auto pressed = pressed_.extract(report.request);
    if (!pressed) return;
    const std::string why{report.reason};
    if (completed) panel_.finish(pressed.mapped());
    else panel_.abort(pressed.mapped(), {ErrorCode::NotPermitted, why.c_str(), static_cast<std::int64_t>(report.code)});
  }

  void service(TimePoint now) override {
    const double period_s = blink_s_.load();
    if (state() != State::Operational || period_s == 0 || now < next_blink_) return;
    next_blink_ = now + std::chrono::duration_cast<Duration>(std::chrono::duration<double>(period_s));
    bright_ = !bright_;
    static_cast<void>(request(fade_, bright_ ? 0.6 : 0.4));
  }

  Result<> operational(const Cycle&) noexcept override {
    answers_.store({completed_, refused_, failed_});
    seen_.store({brightness_, reports_, programs_});
    return ok();
  }

  Request<double> fade_{"LAMP", "FADE"};
  Request<std::uint8_t> set_mode_{"SUPERVISOR", "SET_MODE"};
  Request<> look_{"LAMP", Ask::OneShotHousekeeping, "4800"};
  Subscription<Lamp> lamp_{"LAMP", "4800"};
  EventSubscription<std::uint64_t, std::uint8_t, std::uint8_t, std::array<float, 3>> programmed_{"LAMP", "PROGRAMMED"};
  Parameter<double> blink_s_;
  Parameter<Answers> answers_;
  Parameter<Seen> seen_;
  Parameter<std::uint8_t> mode_;  // the supervisor's, as it comes by its housekeeping
  CustomService panel_{"PANEL"};
  std::map<std::uint32_t, Call> pressed_;  // who waits for which request
  std::atomic<std::uint32_t> completed_{0}, refused_{0}, failed_{0};  // counted in the service loop, shown by the cycle
  std::atomic<double> brightness_{0};
  std::atomic<std::uint32_t> reports_{0}, programs_{0};
  TimePoint next_blink_{};
  bool bright_{false};
};

}  // namespace

std::unique_ptr<Subsystem> make_switch() { return std::make_unique<Switch>(); }

const hirosco::Module* hirosco_module() noexcept { return &hirosco::subsystem_module<make_switch>; }
