// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: states (docs/safety/modules.csv).
#include <utility>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/subsystem/service_loop/generic_subsystem.hpp"

/// CONFIGURE while the subsystem acts, between configurations that its descriptor declares compatible (docs/adr/0096).
namespace hirosco {
namespace {

constexpr Duration reconfiguration_limit = 10s;

}  // namespace

std::expected<void, pus::FailureNotice> GenericSubsystem::command_bumpless(const descriptor::Configuration& wanted,
                                                                           const pus::Request& request) {
  // One that the cycle has not confirmed is still its own.
  if (reconfiguration_ != nullptr || self_tests_.running())
    return std::unexpected{pus::FailureNotice{pus::FailureCode::Busy}};
  // The guard and the second inhibit: who may not move does not go on moving by other values. The cycle looks again.
  const bool permitted = permit_->stop.load(std::memory_order_acquire) == 0 &&
                         permit_->permits(permit_->epoch.load(std::memory_order_acquire));
  if (state_ == State::Operational && (!permitted || vital_.inhibited.load(std::memory_order_relaxed) != 0))
    return std::unexpected{pus::FailureNotice{pus::FailureCode::NotPermittedNow}.with(std::uint8_t{0})};
  const descriptor::Bumpless& terms = *descriptor_.bumpless_between(configuration_->id, wanted.id);
  auto prepared = std::make_unique<Reconfiguration>(Reconfiguration::make(*configuration_, wanted, terms, dictionary_));
  const auto refuse = [&](const Failure& why) -> std::expected<void, pus::FailureNotice> {
    verification_.started(request);
    raise_failure(descriptor::framework_event::configuration_failed, wanted.id, why);
    verification_.completion_failed(
        request, pus::FailureNotice{pus::FailureCode::ExecutionError}.because({why.code, why.number, why.text}));
    return {};
  };
  {
    const LoopsAtRest at_rest{loops_};
    if (descriptor_.offers(housekeeping_service_.type(), &wanted)) {
      if (const auto made = housekeeping_service_.prepare(wanted); !made) {
        housekeeping_service_.drop_prepared();
        return refuse({made.error().code, made.error().text, made.error().value});
      }
    } else housekeeping_service_.prepare_nothing();
    prepared->sampler = housekeeping_service_.prepared_sampler();
  }
  reconfiguration_ = std::move(prepared);
  if (!push({.kind = CommandKind::Reconfigure, .request = request, .reconfiguration = reconfiguration_.get()})) {
    reconfiguration_.reset();
    const LoopsAtRest at_rest{loops_};
    housekeeping_service_.drop_prepared();
    return std::unexpected{pus::FailureNotice{pus::FailureCode::QueueFull}};
  }
  verification_.started(request);
  reconfiguration_request_ = request;
  reconfiguration_deadline_ = platform_.clock.now() + reconfiguration_limit;
  return {};
}

void GenericSubsystem::reconfigured(std::uint8_t id, const std::optional<Failure>& why) {
  if (reconfiguration_ == nullptr || reconfiguration_->to->id != id) return;
  // An output that jumped has failed its node; what the cycle counts by is the new configuration all the same.
  const bool taken = &cycle_.in_force() == reconfiguration_->to;
  {
    const LoopsAtRest at_rest{loops_};
    if (taken) housekeeping_service_.take_prepared();
    else housekeeping_service_.drop_prepared();
  }
  if (taken) {
    configuration_ = reconfiguration_->to;
    self_tests_.applied(configuration_->id);
  }
  reconfiguration_.reset();
  if (why) {
    if (platform_.explain)
      platform_.explain(descriptor_.name + ": CONFIGURE " + descriptor_.find_configuration(id)->name +
                        " failed: " + why->text);
    raise_failure(descriptor::framework_event::configuration_failed, id, *why);
  }
  const auto request = std::exchange(reconfiguration_request_, std::nullopt);
  if (!request) return;
  if (!why) return verification_.completed(*request);
  verification_.completion_failed(
      *request, pus::FailureNotice{pus::FailureCode::ExecutionError}.because({why->code, why->number, why->text}));
}

/// Who asked hears an end. What the cycle may have taken stays until it says so, or rests.
void GenericSubsystem::give_up_reconfiguration(pus::FailureCode code) {
  if (const auto request = std::exchange(reconfiguration_request_, std::nullopt))
    verification_.completion_failed(*request, pus::FailureNotice{code});
}

}  // namespace hirosco
