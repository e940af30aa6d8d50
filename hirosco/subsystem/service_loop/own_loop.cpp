// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/own_loop.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "hirosco/data_transfer/channel/channel.hpp"

namespace hirosco {
namespace {

/// In one step, in watched time: longer is no slow request any more.
constexpr Duration least_hang = std::chrono::milliseconds{500};
constexpr int hang_periods = 3;
/// From so many requests on a queue that is nearly full is worth a warning; below that it is with what it is made for.
constexpr std::uint32_t least_judged = 4;
/// No change has made a step due sooner.
constexpr std::int64_t not_sooner_ns = std::numeric_limits<std::int64_t>::max();

/// In front of a telecommand.
struct Offered {
  std::uint32_t mode_epoch{0};
};

/// In front of what is said.
struct Said {
  std::uint8_t service{0};  ///< 0: an event
  std::uint8_t subtype{0};
  std::uint16_t number{0};  ///< destination, or the event's id
};

template <class T>
[[nodiscard]] Octets octets_of(const T& head) noexcept {
  return std::as_bytes(std::span{&head, 1});
}

template <class T>
[[nodiscard]] T head_of(Octets record) noexcept {
  T head;
  std::memcpy(&head, record.data(), sizeof head);
  return head;
}

}  // namespace

OwnLoop::OwnLoop(const Parts& parts)
    : parts_{parts},
      permit_{&parts.permit},
      in_force_{&parts.declared},
      due_ns_{not_sooner_ns},
      in_{static_cast<std::size_t>(descriptor::loop_requests_octets(parts.declared.queue))},
      out_{parts.reports_octets},
      verification_{*this} {}

bool OwnLoop::offer(Octets packet, std::uint32_t mode_epoch) noexcept {
  const std::uint32_t waiting = waiting_.load(std::memory_order_acquire);
  in_mark_.note(std::min(waiting + 1, parts_.declared.queue), 0, 0);
  if (waiting < parts_.declared.queue) {
    // Counted before it can be taken.
    waiting_.fetch_add(1, std::memory_order_acq_rel);
    if (in_.try_write(octets_of(Offered{mode_epoch}), packet)) return true;
    waiting_.fetch_sub(1, std::memory_order_acq_rel);
  }
  refused_ = true;
  return false;
}

void OwnLoop::tell(const Listener& listener) {
  out_mark_.note(out_.used(), out_.dropped(), out_.capacity());
  while (listener.has_room()) {
    const auto record = out_.front();
    if (!record) return;
    const auto said = head_of<Said>(*record);
    const Octets data = record->subspan(sizeof said);
    if (said.service == 0) listener.event(said.number, data);
    else listener.report(said.service, said.subtype, said.number, data);
    out_.pop();
  }
}

OwnLoop::Fills OwnLoop::take_fills() noexcept {
  in_mark_.note(waiting_.load(std::memory_order_acquire), 0, 0);
  const QueueFill requests{in_mark_.take(), parts_.declared.queue};
  const bool judged = std::exchange(refused_, false) || requests.room >= least_judged;
  return {.requests = requests,
          .reports = {out_mark_.take(), static_cast<std::uint32_t>(out_.capacity())},
          .judged = judged ? requests : QueueFill{}};
}

bool OwnLoop::hangs(Duration passed) noexcept {
  const std::uint64_t steps = steps_.load(std::memory_order_acquire);
  const bool moves = std::exchange(seen_steps_, steps) != steps || !in_step_.load(std::memory_order_acquire);
  stands_for_ = moves ? Duration{0} : stands_for_ + passed;
  if (moves) told_ = false;
  return stands_for_ > std::max(least_hang, hang_periods * in_force().period);
}

void OwnLoop::follow(const descriptor::ServiceLoop& wanted, TimePoint now) noexcept {
  const descriptor::ServiceLoop& before = in_force();
  if (&before == &wanted) return;
  parts_.meter.promise(parts_.place, wanted.budget);
  in_force_.store(&wanted, std::memory_order_release);
  // A longer period is no reason to let wait for longer whoever waits already: it counts from the step that is due.
  if (wanted.period < before.period) {
    const std::int64_t due = (now + wanted.period).time_since_epoch().count();
    due_ns_.store(std::min(due_ns_.load(std::memory_order_relaxed), due), std::memory_order_release);
  }
  wake();
}

TimePoint OwnLoop::due(TimePoint planned) const noexcept {
  return std::min(planned, TimePoint{Duration{due_ns_.load(std::memory_order_acquire)}});
}

TimePoint OwnLoop::step(TimePoint planned) {
  std::optional<RealtimeScope> watched;
  if (commissioned()) watched.emplace();
  const Duration used = parts_.clock.processor();
  // To the end: what it took is held against the budget that it was made under.
  const LockGuard lock{mutex_};
  planned = std::min(planned, TimePoint{Duration{due_ns_.exchange(not_sooner_ns, std::memory_order_acq_rel)}});
  in_step_.store(true, std::memory_order_release);
  for (std::uint32_t left = parts_.declared.queue; left > 0 && has_room(max_packet_octets); --left) {
    const auto record = in_.front();
    if (!record) break;
    handle(*record);
    in_.pop();
    waiting_.fetch_sub(1, std::memory_order_acq_rel);
  }
  const TimePoint now = parts_.clock.now();
  for (pus::Service* service : services_.all()) service->step(now);
  steps_.fetch_add(1, std::memory_order_acq_rel);
  in_step_.store(false, std::memory_order_release);
  const Duration period = in_force().period;
  const TimePoint next = planned + period;
  const TimePoint finished = parts_.clock.now();
  const auto missed = finished <= next ? 0 : (finished - next) / period + 1;
  parts_.meter.account(parts_.place, parts_.clock.processor() - used, static_cast<std::uint64_t>(missed));
  if (watched && commissioned()) {
    const AllocationCount uses = watched->count();
    allocations_.fetch_add(uses.allocations, std::memory_order_relaxed);
    frees_.fetch_add(uses.frees, std::memory_order_relaxed);
  }
  return next + missed * period;
}

/// What a configuration takes from the heap it takes in the service loop, while this one rests.
bool OwnLoop::commissioned() const noexcept {
  const auto told = told_state();
  return told == descriptor::State::SafeOperational || told == descriptor::State::Operational;
}

void OwnLoop::handle(Octets record) {
  const auto offered = head_of<Offered>(record);
  const auto telecommand = pus::TelecommandView::parse(record.subspan(sizeof offered));
  if (!telecommand) return;  // the service loop has looked
  const pus::Request request = pus::request_of(*telecommand);
  // What an old mode permitted is not done under a new one, however long it has waited.
  permitted_by_ = offered.mode_epoch;
  if (!mode_in_force()) return verification_.rejected(request, pus::FailureNotice{pus::FailureCode::WrongMode});
  // Nor what a configuration leaves out that came into force meanwhile.
  const std::uint32_t configuration = parts_.vital.configuration.load(std::memory_order_acquire);
  if (!descriptor().offers(telecommand->service(),
                           descriptor().find_configuration(static_cast<std::uint8_t>(configuration))))
    return verification_.rejected(request,
                                  pus::FailureNotice{pus::FailureCode::UnknownService}.with(telecommand->service()));
  pus::Service* const service = services_.find(telecommand->service());
  if (service == nullptr || !service->in_force() || !told_state())
    return verification_.rejected(
        request, pus::FailureNotice{pus::FailureCode::WrongState}.with(static_cast<std::uint8_t>(state())));
  service->handle(*telecommand, request);
}

bool OwnLoop::mode_in_force() const noexcept {
  if (permitted_by_ == 0) return true;
  const PermitPage& page = *permit_.load(std::memory_order_acquire);
  return page.mode_epoch.load(std::memory_order_acquire) == permitted_by_;
}

/// Empty: the page was damaged, for which the guard ends the process.
std::optional<descriptor::State> OwnLoop::told_state() const noexcept {
  const std::uint32_t state = parts_.vital.state.load(std::memory_order_acquire);
  if (state > static_cast<std::uint32_t>(descriptor::State::SoftwareDeinit)) return std::nullopt;
  return static_cast<descriptor::State>(state);
}

descriptor::State OwnLoop::state() const noexcept { return told_state().value_or(descriptor::State::Offline); }

/// Whoever asks is always answered: what a service says of its own accord leaves half of the way out to that.
bool OwnLoop::has_room(std::size_t octets) const noexcept { return out_.used() + octets <= out_.capacity() / 2; }

void OwnLoop::report(std::uint8_t service, std::uint8_t subtype, std::uint16_t destination, Octets source_data) {
  static_cast<void>(out_.try_write(octets_of(Said{service, subtype, destination}), source_data));
}

Result<> OwnLoop::store(const ParameterCell& parameter, Octets big_endian) {
  for (std::size_t i = 0; i < parts_.dictionary.size(); ++i) {
    if (parts_.dictionary.cell(i) != &parameter) continue;
    const ParameterWrite write{static_cast<std::uint16_t>(i), -1, big_endian};
    return parts_.writes.enqueue(parts_.dictionary, {&write, 1});
  }
  return fail(ErrorCode::NotFound, "the parameter is not published");
}

Result<> OwnLoop::raise(std::string_view event, Octets auxiliary) {
  const descriptor::Event* declared = descriptor().find_event(event);
  if (declared == nullptr) return fail(ErrorCode::NotFound, "the descriptor declares no such event");
  if (!has_room(auxiliary.size())) return fail(ErrorCode::ResourceExhausted, "the service loop is behind");
  report(0, 0, declared->id, auxiliary);
  return ok();
}

LoopsAtRest::LoopsAtRest(const std::vector<std::unique_ptr<OwnLoop>>& loops) noexcept : loops_{loops} {
  for (const auto& loop : loops_) loop->mutex().lock();
}

LoopsAtRest::~LoopsAtRest() {
  for (const auto& loop : loops_) loop->mutex().unlock();
}

}  // namespace hirosco
