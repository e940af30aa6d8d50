// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/link_ends.hpp"

#include <algorithm>
#include <utility>

namespace hirosco {

const descriptor::Requires* LinkEnds::find_required(std::string_view set) {
  if (parts_.at.configuration == nullptr || !is_cyclic(parts_.at.state)) return nullptr;
  const auto found = std::ranges::find(parts_.at.configuration->requires_, set, &descriptor::Requires::name);
  return found != parts_.at.configuration->requires_.end() ? &*found : nullptr;
}

const LinkOutputSlot* LinkEnds::find_provided(std::string_view set) {
  if (parts_.at.configuration == nullptr || !is_cyclic(parts_.at.state)) return nullptr;
  const auto& outputs = parts_.cycle.plan().outputs;
  const auto found = std::ranges::find_if(outputs, [&](const auto& slot) { return slot.terms().name == set; });
  return found != outputs.end() ? &*found : nullptr;
}

/// The same for the handshake, where it can be said in words, and for the attachment, where it counts.
std::string LinkEnds::refuse_link(pus::st128::Role role, std::string_view set, std::uint8_t link) {
  if (role == pus::st128::Role::Producer) return {};
  // What a consumer acts on is settled before it acts (adr 0021). A link that it has, whose partner left and came back, is
  // no new one; and a set whose absence is only held over comes and goes.
  const descriptor::Requires* wanted = find_required(set);
  const bool settled = wanted != nullptr && wanted->required && !ends_.contains(link) &&
                       wanted->missing == descriptor::MissingPolicy::Inhibit;
  if (settled && parts_.at.state != State::PreOperational)
    return "links into a set are made in PreOperational, this is " + std::string{to_text(parts_.at.state)};
  const bool has_another = std::ranges::any_of(ends_, [&](const auto& entry) {
    const End& end = entry.second;
    return entry.first != link && end.role == role && parts_.at.configuration->requires_[end.slot].name == set;
  });
  return has_another ? "the set has a link already" : "";
}

bool LinkEnds::carries(LinkMethod method, LinkKind kind, bool wakes) {
  const LinkMechanism* mechanism = find_link_mechanism(parts_.platform.links, method, kind);
  return mechanism != nullptr && (mechanism->wakes() || !wakes);
}

Duration LinkEnds::period() {
  return parts_.at.configuration != nullptr ? parts_.at.configuration->sampling : Duration{};
}

Result<LinkRoute> LinkEnds::attach(const pus::st128::AttachRequest& request, const MemoryHandle& memory) {
  if (parts_.at.configuration == nullptr) return fail(ErrorCode::NotPermitted, "no configuration in force");
  // A later epoch: the partner left without this end and came back, and what this end still holds is the link as it was.
  const auto earlier = ends_.find(request.link);
  const bool renewed = earlier != ends_.end() && request.epoch > earlier->second.epoch;
  if (earlier != ends_.end() && !renewed) return fail(ErrorCode::AlreadyExists, "the link is attached already");
  refusal_ = refuse_link(request.role, request.set, request.link);
  if (!refusal_.empty()) return fail(ErrorCode::NotPermitted, refusal_.c_str());
  const bool producer = request.role == pus::st128::Role::Producer;
  const pus::st128::Agreement& agreement = request.agreement;
  LinkLayout layout = agreement.layout(request.header_epoch());
  layout.route = request.route;
  const LinkMechanism* mechanism = find_link_mechanism(parts_.platform.links, agreement.method, agreement.kind);
  if (mechanism == nullptr) return fail(ErrorCode::NotPermitted, "no mechanism here carries such a link");
  if (mechanism->in_memory() && !memory) return fail(ErrorCode::Malformed, "no memory beside the attach request");
  auto link = std::make_unique<AttachedLink>();
  if (mechanism->ends_at() == LinkEndsAt::Addresses) {
    HIROSCO_TRY_LET(link->port, parts_.resources.ports().take());
  }
  link->id = request.link;
  link->made = request.header_epoch();
  link->agreement = agreement;
  link->order = agreement.byte_order == descriptor::ByteOrder::Big ? std::endian::big : std::endian::little;
  HIROSCO_TRY_LET(const std::uint16_t slot, producer ? make_producer(request, *mechanism, memory, layout, *link)
                                                     : make_consumer(request, *mechanism, memory, layout, *link));
  if (renewed && !withdraw(request.link))
    return fail(ErrorCode::ResourceExhausted, "the cycle's command queue is full");
  const auto kind = producer ? CommandKind::AttachOutput : CommandKind::AttachInput;
  if (!parts_.rings.command({.kind = kind, .index = slot, .link = link.get()}))
    return fail(ErrorCode::ResourceExhausted, "the cycle's command queue is full");
  const LinkRoute route = link->writer ? link->writer->route() : link->reader ? link->reader->route() : LinkRoute{};
  ends_.emplace(request.link, End{std::move(link), request.role, request.epoch, slot});
  return route;
}

Result<std::uint16_t> LinkEnds::make_producer(const pus::st128::AttachRequest& request, const LinkMechanism& mechanism,
                                              const MemoryHandle& memory, const LinkLayout& layout,
                                              AttachedLink& link) {
  const pus::st128::Agreement& agreement = request.agreement;
  CyclePlan& plan = parts_.cycle.plan();
  const auto slot = std::ranges::find_if(plan.outputs, [&](const auto& s) { return s.terms().name == request.set; });
  if (slot == plan.outputs.end()) return fail(ErrorCode::NotFound, "no such provided set");
  // Another configuration may be in force than the one that negotiated; the cycle writes these fields unchecked.
  if (agreement.fields != slot->fields()) return fail(ErrorCode::Mismatch, "the agreement is not of this set");
  if ((agreement.kind == LinkKind::Loaned) != slot->terms().terms.lent())
    return fail(ErrorCode::Mismatch, "the agreement lends and the set is copied, or the reverse");
  const auto index = static_cast<std::uint16_t>(slot - plan.outputs.begin());
  if (agreement.kind == LinkKind::Loaned) {
    if (request.made != 0) link.lender = lender_of(index, layout);
    if (link.lender == nullptr) {
      HIROSCO_TRY_LET(link.lender, mechanism.lend(parts_.platform.memory, memory, layout));
    }
  } else {
    HIROSCO_TRY_LET(link.writer, mechanism.produce(parts_.platform.memory, memory, layout));
  }
  return index;
}

Result<std::uint16_t> LinkEnds::make_consumer(const pus::st128::AttachRequest& request, const LinkMechanism& mechanism,
                                              const MemoryHandle& memory, const LinkLayout& layout,
                                              AttachedLink& link) {
  CyclePlan& plan = parts_.cycle.plan();
  const auto slot = std::ranges::find_if(plan.inputs, [&](const auto& s) { return s.terms().name == request.set; });
  if (slot == plan.inputs.end()) return fail(ErrorCode::NotFound, "no such required set");
  HIROSCO_TRY(slot->plan(link));
  if (request.agreement.kind == LinkKind::Loaned) {
    HIROSCO_TRY_LET(link.borrower, mechanism.borrow(parts_.platform.memory, memory, layout));
  } else {
    HIROSCO_TRY_LET(link.reader, mechanism.consume(parts_.platform.memory, memory, layout));
    link.payload.resize(layout.payload_octets);
  }
  return static_cast<std::uint16_t>(slot - plan.inputs.begin());
}

/// Who looks at a set that is lent already looks at the same memory. Null: no link has that one.
std::shared_ptr<LoanWriter> LinkEnds::lender_of(std::uint16_t slot, const LinkLayout& layout) {
  for (const auto& [id, end] : ends_) {
    if (end.role != pus::st128::Role::Producer || end.slot != slot || end.link->made != layout.epoch) continue;
    if (layout.wakes) end.link->lender->start_waking();
    return end.link->lender;
  }
  return nullptr;
}

/// The cycle may be writing: an end is told beside that where its samples go.
Result<LinkRoute> LinkEnds::reach(const pus::st128::ReachRequest& request) {
  const auto found = ends_.find(request.link);
  if (found == ends_.end() || found->second.role != pus::st128::Role::Producer ||
      found->second.epoch != request.epoch || found->second.link->writer == nullptr)
    return fail(ErrorCode::NotFound, "no such end of a link is attached here");
  LinkWriter& writer = *found->second.link->writer;
  HIROSCO_TRY(writer.reach(request.consumer));
  return writer.route();
}

bool LinkEnds::detach(std::uint8_t link) {
  const auto found = ends_.find(link);
  if (found == ends_.end()) return false;
  const pus::st128::Role role = found->second.role;
  if (!withdraw(link)) return false;
  service_.report_detached(link, role);
  return true;
}

/// Takes an end back from the cycle, which names it when it has let go of it.
bool LinkEnds::withdraw(std::uint8_t link) {
  const auto found = ends_.find(link);
  End& end = found->second;
  const bool producer = end.role == pus::st128::Role::Producer;
  const auto kind = producer ? CommandKind::DetachOutput : CommandKind::DetachInput;
  if (!parts_.rings.command({.kind = kind, .index = end.slot, .link = end.link.get()})) return false;
  leaving_.push_back(std::move(end.link));
  ends_.erase(found);
  return true;
}

bool LinkEnds::required_attached() const noexcept {
  return std::ranges::all_of(parts_.at.configuration->requires_, [&](const descriptor::Requires& wanted) {
    if (!wanted.required) return true;
    return std::ranges::any_of(ends_, [&](const auto& entry) {
      const End& end = entry.second;
      return end.role == pus::st128::Role::Consumer && &parts_.at.configuration->requires_[end.slot] == &wanted;
    });
  });
}

void LinkEnds::let_go(const AttachedLink* link) {
  std::erase_if(leaving_, [&](const auto& left) { return left.get() == link; });
}

void LinkEnds::end() {
  for (const auto& [link, end] : ends_) {
    // An announced end is not a stale link: consumers make themselves safe without an alarm.
    if (end.role == pus::st128::Role::Producer) set_status(*end.link, LinkStatus::Stopping);
    service_.report_detached(link, end.role);
  }
  for (auto& [link, end] : ends_) leaving_.push_back(std::move(end.link));
  ends_.clear();
}

}  // namespace hirosco
