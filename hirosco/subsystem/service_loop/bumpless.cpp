// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: states (docs/safety/modules.csv).
#include "hirosco/subsystem/service_loop/bumpless.hpp"

#include <utility>

#include "hirosco/descriptor/model/framework_events.hpp"

namespace hirosco {
namespace {

constexpr Duration reconfiguration_limit = 10s;

}  // namespace

std::expected<void, pus::FailureNotice> Bumpless::command(const descriptor::Configuration& wanted,
                                                          const pus::Request& request) {
  // One that the cycle has not confirmed is still its own.
  if (change_ != nullptr || parts_.self_tests.running())
    return std::unexpected{pus::FailureNotice{pus::FailureCode::Busy}};
  // The guard and the second inhibit: who may not move does not go on moving by other values. The cycle looks again.
  const PermitPage& permit = parts_.permit.page();
  const bool permitted =
      permit.stop.load(std::memory_order_acquire) == 0 && permit.permits(permit.epoch.load(std::memory_order_acquire));
  if (parts_.at.state == State::Operational &&
      (!permitted || parts_.vital.inhibited.load(std::memory_order_relaxed) != 0))
    return std::unexpected{pus::FailureNotice{pus::FailureCode::NotPermittedNow}.with(std::uint8_t{0})};
  const descriptor::Bumpless& terms = *parts_.descriptor.bumpless_between(parts_.at.configuration->id, wanted.id);
  auto prepared = std::make_unique<Reconfiguration>(
      Reconfiguration::make(*parts_.at.configuration, wanted, terms, parts_.values.dictionary()));
  const auto refuse = [&](const Failure& why) -> std::expected<void, pus::FailureNotice> {
    parts_.reports.verification().started(request);
    parts_.reports.raise_failure(descriptor::framework_event::configuration_failed, wanted.id, why);
    parts_.reports.verification().completion_failed(
        request, pus::FailureNotice{pus::FailureCode::ExecutionError}.because({why.code, why.number, why.text}));
    return {};
  };
  {
    const LoopsAtRest at_rest{parts_.loops.all()};
    if (parts_.descriptor.offers(parts_.housekeeping.type(), &wanted)) {
      if (const auto made = parts_.housekeeping.prepare(wanted); !made) {
        parts_.housekeeping.drop_prepared();
        return refuse({made.error().code, made.error().text, made.error().value});
      }
    } else parts_.housekeeping.prepare_nothing();
    prepared->sampler = parts_.housekeeping.prepared_sampler();
  }
  hold(std::move(prepared));
  if (!parts_.rings.command({.kind = CommandKind::Reconfigure, .request = request, .reconfiguration = change_.get()})) {
    hold(nullptr);
    const LoopsAtRest at_rest{parts_.loops.all()};
    parts_.housekeeping.drop_prepared();
    return std::unexpected{pus::FailureNotice{pus::FailureCode::QueueFull}};
  }
  parts_.reports.verification().started(request);
  request_ = request;
  deadline_ = parts_.platform.clock.now() + reconfiguration_limit;
  return {};
}

void Bumpless::ended(std::uint8_t id, const std::optional<Failure>& why) {
  if (change_ == nullptr || change_->to->id != id) return;
  // An output that jumped has failed its node; what the cycle counts by is the new configuration all the same.
  const bool taken = &parts_.cycle.in_force() == change_->to;
  {
    const LoopsAtRest at_rest{parts_.loops.all()};
    // What ST[20] has set in one of them was set before this, and is told before it.
    parts_.loops.tell(parts_.reports);
    if (taken) {
      parts_.housekeeping.take_prepared();
      parts_.loops.follow(change_->to);
    } else parts_.housekeeping.drop_prepared();
  }
  if (taken) {
    parts_.at.configuration = change_->to;
    parts_.self_tests.applied(parts_.at.configuration->id);
  }
  hold(nullptr);
  if (why) {
    if (parts_.platform.explain)
      parts_.platform.explain(parts_.descriptor.name + ": CONFIGURE " + parts_.descriptor.find_configuration(id)->name +
                              " failed: " + why->text);
    parts_.reports.raise_failure(descriptor::framework_event::configuration_failed, id, *why);
  }
  const auto request = std::exchange(request_, std::nullopt);
  if (!request) return;
  if (!why) return parts_.reports.verification().completed(*request);
  parts_.reports.verification().completion_failed(
      *request, pus::FailureNotice{pus::FailureCode::ExecutionError}.because({why->code, why->number, why->text}));
}

/// While there is one ST[20] sets nothing: nobody could say whether it was set before what the configuration sets or behind it.
void Bumpless::hold(std::unique_ptr<Reconfiguration> change) noexcept {
  const LockGuard lock{parts_.values.judging()};
  change_ = std::move(change);
  parts_.values.go_over(change_ != nullptr);
}

void Bumpless::step(TimePoint now) {
  if (request_ && now > deadline_) give_up(pus::FailureCode::Timeout);
}

/// Who asked hears an end. What the cycle may have taken stays until it says so, or rests.
void Bumpless::give_up(pus::FailureCode code) {
  if (const auto request = std::exchange(request_, std::nullopt))
    parts_.reports.verification().completion_failed(*request, pus::FailureNotice{code});
}

}  // namespace hirosco
