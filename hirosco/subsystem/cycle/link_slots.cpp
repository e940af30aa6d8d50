// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include "hirosco/subsystem/cycle/link_slots.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace hirosco {
namespace {

/// Cycles without news are counted up to here, so that a counter never wraps back to "fresh".
constexpr std::uint32_t longest_age = 1'000'000'000;

}  // namespace

void set_status(AttachedLink& link, LinkStatus status) noexcept {
  link.told = status;
  if (link.lender != nullptr) link.lender->set_status(status);
  else link.writer->set_status(status);
}

LinkInputSlot::LinkInputSlot(const descriptor::Requires& terms, LinkInputPort* port, bool realtime) noexcept
    : terms_{&terms}, port_{port}, age_limit_{realtime ? terms.age.realtime : terms.age.reduced} {
  for (std::size_t i = 0; i < terms.fields.size(); ++i)
    port_->layout_.set_length(i, terms.fields[i].count, port_->native_);
  port_->loans_ = nullptr;
  port_->places_ = nullptr;
  port_->arrived_ = 0;
  port_->valid_ = false;
  port_->age_cycles_ = 0;
  port_->status_ = LinkStatus::None;
  port_->count_ = 0;
}

Result<> LinkInputSlot::plan(AttachedLink& link) const {
  link.scatter.clear();
  link.wire_offset.clear();
  const bool lent = link.agreement.kind == LinkKind::Loaned;
  if (link.agreement.kind != port_->kind())
    return fail(ErrorCode::Mismatch, "the agreement is of another kind than the port");
  if (link.agreement.wakes != terms_->starts)
    return fail(ErrorCode::Mismatch, "the agreement wakes whom no sample starts, or the reverse");
  if (lent && link.agreement.fields.size() != terms_->fields.size())
    return fail(ErrorCode::Mismatch, "the agreement has other fields than the lent set");
  for (std::size_t wanted = 0; wanted < terms_->fields.size(); ++wanted) {
    std::size_t offset = 0;
    const auto found = std::ranges::find_if(link.agreement.fields, [&](const pus::st128::OfferedField& field) {
      if (field.name == terms_->fields[wanted].name) return true;
      offset += octets_of(field.type) * field.count;
      return false;
    });
    if (found == link.agreement.fields.end()) return fail(ErrorCode::Mismatch, "the agreement lacks a required field");
    const NativeField& place = port_->layout()[wanted];
    if (found->type != place.type || found->count != place.count)
      return fail(ErrorCode::Mismatch, "the agreement has a required field with another type");
    if (lent) {
      if (found - link.agreement.fields.begin() == static_cast<std::ptrdiff_t>(wanted)) continue;
      return fail(ErrorCode::Mismatch, "the agreement has the fields of the lent set in another order");
    }
    link.scatter.push_back({place.type, place.count, place.offset});
    link.wire_offset.push_back(offset);
  }
  if (link.agreement.kind != LinkKind::Queued) return ok();
  const std::size_t each = port_->native_.size();
  if (each * link.agreement.depth > max_queue_octets)
    return fail(ErrorCode::ResourceExhausted, "the places of a queue", static_cast<std::int64_t>(each));
  link.places.resize(each * link.agreement.depth);
  for (std::size_t at = 0; at < link.places.size(); at += each)
    std::memcpy(link.places.data() + at, port_->native_.data(), each);
  return ok();
}

void LinkInputSlot::attach(AttachedLink* link) noexcept {
  link_ = link;
  port_->loans_ = link->borrower.get();
  port_->places_ = link->places.data();
  port_->arrived_ = 0;
  port_->age_cycles_ = 0;
  // What an earlier link brought must not pass for a sample of this one.
  port_->count_ = 0;
  port_->received_ = 0;
  port_->lost_ = 0;
  port_->status_ = LinkStatus::None;
  latency_mean_ns_ = 0.0;
  latency_max_ns_ = 0;
  jitter_ns_ = 0.0;
  forget_latencies();
}

void LinkInputSlot::forget_latencies() noexcept {
  latencies_.fill(0);
  untold_bins_ = all_bins;
}

bool LinkInputSlot::awaits_first(bool controlling, bool counts) noexcept {
  came_ = controlling && (came_ || port_->valid_);
  if (!controlling) awaited_cycles_ = 0;
  if (!controlling || came_ || link_ == nullptr || link_->producer_cycles_per_sample <= 1) return false;
  if (awaited_cycles_ >= age_limit_ * link_->producer_cycles_per_sample) return false;
  if (counts) ++awaited_cycles_;
  return true;
}

void AttachedLink::count_in(Duration consumer_period) noexcept {
  const auto ratio = agreement.producer_period / std::max(consumer_period, Duration{1});
  producer_cycles_per_sample = static_cast<std::uint32_t>(std::max<std::int64_t>(ratio, 1));
}

void LinkInputSlot::follow(Duration sampling) noexcept {
  if (link_ != nullptr) link_->count_in(sampling);
}

void LinkInputSlot::detach(const AttachedLink* link) noexcept {
  if (link_ != link) return;
  link_ = nullptr;
  port_->loans_ = nullptr;
  port_->places_ = nullptr;
  port_->arrived_ = 0;
  port_->valid_ = false;
  port_->status_ = LinkStatus::None;
}

void LinkInputSlot::read(TimePoint now, bool counts) noexcept {
  newest_latency_.reset();
  read_at_ = now;
  if (link_ == nullptr) {
    port_->valid_ = false;
    return;
  }
  const LinkSample sample = port_->kind() == LinkKind::Queued ? read_all(now) : read_newest(now);
  if (sample.flow == Flow::New) port_->age_cycles_ = 0;
  else if (counts && port_->age_cycles_ < longest_age) ++port_->age_cycles_;
  port_->status_ = sample.status;
  const bool fresh = port_->age_cycles_ <= age_limit_ * link_->producer_cycles_per_sample;
  port_->valid_ = port_->count_ != 0 && fresh && reliable();
}

const std::uint32_t* LinkInputSlot::arrival_word() const noexcept {
  if (link_ == nullptr) return nullptr;
  return port_->lent() ? link_->borrower->arrival_word() : link_->reader->arrival_word();
}

LinkSample LinkInputSlot::read_newest(TimePoint now) noexcept {
  // What is lent stays where it is: there is nothing to scatter.
  const LinkSample sample = port_->lent() ? link_->borrower->newest() : link_->reader->read(link_->payload);
  if (sample.flow == Flow::New) take(sample, port_->native_, now);
  return sample;
}

/// As many as have a place; what is left comes in the next cycle. Told is the newest of them, with the worst status.
LinkSample LinkInputSlot::read_all(TimePoint now) noexcept {
  const std::size_t each = port_->native_.size();
  LinkSample told;
  for (port_->arrived_ = 0; port_->arrived_ < link_->agreement.depth; ++port_->arrived_) {
    const LinkSample sample = link_->reader->read(link_->payload);
    told.status = std::max(told.status, sample.status);
    if (sample.flow != Flow::New) break;
    take(sample, MutableOctets{link_->places}.subspan(port_->arrived_ * each, each), now);
    told.flow = Flow::New;
  }
  return told;
}

/// A sample goes where the author sees it, and into the account of the link.
void LinkInputSlot::take(const LinkSample& sample, MutableOctets into, TimePoint now) noexcept {
  for (std::size_t i = 0; i < link_->scatter.size(); ++i) {
    const LayoutField& field = link_->scatter[i];
    const std::size_t octets = octets_of(field.type) * field.count;
    decode(std::span{&field, 1}, Octets{link_->payload}.subspan(link_->wire_offset[i], octets), into, link_->order);
  }
  port_->count_ = sample.count;
  ++port_->received_;
  port_->lost_ += sample.lost;
  newest_latency_ = now - sample.sampled_at;
  newest_at_ = sample.sampled_at;
  // RFC 3550, 6.4.1: both ends have one clock, so that the difference of two transits is that of two latencies.
  const Duration before = std::exchange(latency_before_, *newest_latency_);
  if (port_->received_ > 1) {
    const auto apart = std::abs(static_cast<double>((*newest_latency_ - before).count()));
    jitter_ns_ += (apart - jitter_ns_) / 16;
  }
  const std::size_t bin = latency_bin(*newest_latency_, link_->agreement.producer_period);
  ++latencies_[bin];
  untold_bins_ |= 1U << bin;
  const std::uint32_t latency_ns = clamped_ns(*newest_latency_);
  latency_max_ns_ = std::max(latency_max_ns_, latency_ns);
  // The first samples weigh as much as they are, so that the mean needs no time to arrive.
  const double weight = std::max(1.0 / static_cast<double>(port_->received_), 1e-3);
  latency_mean_ns_ += weight * (static_cast<double>(latency_ns) - latency_mean_ns_);
}

void LinkInputSlot::tell(IncomingLink& page) const noexcept {
  constexpr auto relaxed = std::memory_order_relaxed;
  page.link.store(link_ != nullptr ? link_->id : 0, relaxed);
  page.lost.store(static_cast<std::uint32_t>(port_->lost_), relaxed);
  page.latency_mean_ns.store(static_cast<std::uint32_t>(latency_mean_ns_), relaxed);
  page.latency_max_ns.store(latency_max_ns_, relaxed);
  page.jitter_ns.store(static_cast<std::uint32_t>(std::min(jitter_ns_, 4e9)), relaxed);
  const auto age_us = (read_at_ - newest_at_) / std::chrono::microseconds{1};
  page.age_us.store(
      port_->count_ == 0 ? 0 : static_cast<std::uint32_t>(std::clamp<std::int64_t>(age_us, 0, 4'000'000'000)), relaxed);
}

void LinkInputSlot::tell(LinkLatencies& page) noexcept {
  constexpr auto relaxed = std::memory_order_relaxed;
  // First of all the period: with another one the counts mean something else.
  if (untold_bins_ == all_bins)
    page.period_ns.store(link_ != nullptr ? clamped_ns(link_->agreement.producer_period) : 0, relaxed);
  for (; untold_bins_ != 0; untold_bins_ &= untold_bins_ - 1) {
    const auto bin = static_cast<std::size_t>(std::countr_zero(untold_bins_));
    page.counts[bin].store(latencies_[bin], relaxed);
  }
}

LinkOutputSlot::LinkOutputSlot(const descriptor::SubsystemDescriptor& subsystem, const descriptor::Provides& terms,
                               Dictionary& dictionary, LoanOutputPort* port)
    : terms_{&terms}, port_{port} {
  for (const descriptor::Field& field : terms.fields) fields_.push_back({field.name, field.type, field.count});
  lend_first();
  if (terms.terms.lent()) return;
  for (const descriptor::ParameterRef& reference : terms.parameters) {
    const ParameterCell* cell = dictionary.cell(reference.parameter);
    const auto& layout = cell->fields();
    const auto fields = descriptor::fields_of(subsystem, reference);
    const auto& parameter = subsystem.parameters[reference.parameter];
    const auto first =
        static_cast<std::size_t>(parameter.members_at(reference.member).data() - parameter.members.data());
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const NativeField& native = layout[first + i];
      fields_.push_back({fields[i].name, fields[i].type, fields[i].count});
      sources_.push_back({cell, {native.type, native.count, native.offset}});
    }
  }
  std::size_t octets = 0;
  for (const auto& field : fields_) octets += octets_of(field.type) * field.count;
  for (auto& payload : payloads_) payload.resize(octets);
}

void LinkOutputSlot::attach(AttachedLink* link) noexcept {
  AttachedLink** end = &first_;
  while (*end != nullptr) end = &(*end)->next;
  link->next = nullptr;
  *end = link;
  lend_first();
}

void LinkOutputSlot::detach(AttachedLink* link) noexcept {
  for (AttachedLink** place = &first_; *place != nullptr; place = &(*place)->next)
    if (*place == link) {
      *place = link->next;
      lend_first();
      return;
    }
}

void LinkOutputSlot::release() noexcept {
  first_ = nullptr;
  lend_first();
}

/// What was being made in the memory of a link that is gone went with it.
void LinkOutputSlot::lend_first() noexcept {
  LoanWriter* const first = first_ != nullptr ? first_->lender.get() : nullptr;
  if (port_ == nullptr || port_->loans_ == first) return;
  port_->loans_ = first;
  port_->lent_ = port_->ready_ = false;
}

/// Whether an earlier link has the same memory: all that was told by it.
bool LinkOutputSlot::has_told(const AttachedLink& link) const noexcept {
  const AttachedLink* earlier = first_;
  while (earlier->lender != link.lender) earlier = earlier->next;
  return earlier != &link;
}

/// One memory for all consumers, or, where the supervisor gave a link memory of its own, a copy of what was made for the first.
void LinkOutputSlot::hand_on(TimePoint now, LinkStatus status) noexcept {
  const bool ready = std::exchange(port_->ready_, false);
  if (ready) port_->lent_ = false;
  for (AttachedLink* link = first_; link != nullptr; link = link->next) {
    if (has_told(*link)) {
      link->told = status;
    } else if (ready && link != first_) {
      const MutableOctets made = first_->lender->lend();
      std::memcpy(link->lender->lend().data(), made.data(), made.size());
      link->lender->publish(now, status);
      link->told = status;
    } else if (!ready && link->told != status) set_status(*link, status);
  }
  if (!ready) return;  // what is ready was made in the memory of the first, which is there still
  first_->lender->publish(now, status);
  first_->told = status;
}

void LinkOutputSlot::encode_for(std::endian order) noexcept {
  std::size_t at = 0;
  for (const Source& source : sources_) {
    const std::size_t octets = octets_of(source.field.type) * source.field.count;
    encode(std::span{&source.field, 1}, source.cell->live(), payload(order).subspan(at, octets), order);
    at += octets;
  }
}

void LinkOutputSlot::write(TimePoint now, LinkStatus status) noexcept {
  if (port_ != nullptr) return hand_on(now, status);
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    bool encoded = false;
    for (AttachedLink* link = first_; link != nullptr; link = link->next) {
      if (link->order != order) continue;
      if (!encoded) encode_for(order);
      encoded = true;
      link->writer->write(payload(order), now, status);
    }
  }
}

}  // namespace hirosco
