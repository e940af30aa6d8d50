// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/downlink/catch_up.hpp"

#include <algorithm>

namespace hirosco::ground {
namespace {

namespace st129 = pus::st129;

/// What a report is stamped with and when it is stored differ by as much.
constexpr Duration margin = std::chrono::seconds{2};
/// A craft says something as often: what is left of a gap before the first report of it is none.
constexpr Duration quiet = std::chrono::seconds{2};

}  // namespace

void CatchUp::missing(OnboardTime from, OnboardTime to, After after) {
  if (to <= from) return;
  if (to - from <= whole_span) return add({.from = from, .to = to, .after = after});
  // First the latest: it is what somebody looks at.
  add({.from = to - whole_span, .to = to, .closes_gap = false});
  add({.from = from, .to = to, .housekeeping = false, .after = after});
}

void CatchUp::add(const Wanted& wanted) {
  // Packets that come one by one over a bad link leave many small gaps: near ones are fetched together.
  if (const std::size_t open = past_ ? 1 : 0; wanted_.size() > open) {
    Wanted& last = wanted_.back();
    const bool near = wanted.from - last.to < margin && last.closes_gap && wanted.closes_gap &&
                      wanted.from >= last.from && wanted.after == After::APacket;
    if (near && last.housekeeping == wanted.housekeeping && std::max(last.to, wanted.to) - last.from <= whole_span) {
      last.from = std::min(last.from, wanted.from);
      last.to = std::max(last.to, wanted.to);
      return;
    }
  }
  if (wanted_.size() < most_spans) wanted_.push_back(wanted);
}

void CatchUp::link_up() { connected_ = true; }

void CatchUp::link_down() {
  connected_ = false;
  past_.reset();  // it is asked for again
}

void CatchUp::tick() {
  const TimePoint now = parts_.clock.now();
  if (past_ && now - heard_at_ < patience) return;
  if (past_) {
    past_.reset();
    if (wanted_.front().tries >= most_tries) wanted_.pop_front();
  }
  if (!connected_ || wanted_.empty() || now - heard_at_ < std::chrono::seconds{0}) return;
  Wanted& next = wanted_.front();
  const OnboardTime from = next.from - OnboardTime{} < margin ? OnboardTime{} : next.from - margin;
  const auto request = parts_.ask({from, next.to + margin, next.housekeeping});
  if (!request) return;
  request_ = *request;
  ++next.tries;
  past_.emplace(parts_.catalogue);
  first_.reset();
  heard_at_ = now;
}

bool CatchUp::hear(const pus::TelemetryView& packet) {
  if (packet.apid() != parts_.catalogue.mission().supervisor.id || packet.service() != st129::service_type)
    return false;
  const bool report = st129::is_retrieved(packet);
  if (!report && packet.subtype() != st129::retrieval_end) return false;
  if (packet.destination() != parts_.source || !past_) return true;  // another station's
  heard_at_ = parts_.clock.now();
  if (report) {
    if (const auto retrieved = st129::read_retrieved(packet.source_data())) take(retrieved->packet);
  } else if (const auto end = st129::read_retrieval_end(packet.source_data())) {
    finish(*end);
  }
  return true;
}

bool CatchUp::is_known(const pus::TelemetryView& packet, Octets octets) const {
  bool known = false;
  parts_.archive.packets({packet.time(), packet.time()}, [&](const StoredPacket& stored) {
    known = std::ranges::equal(stored.octets, octets);
    return !known;
  });
  return known;
}

void CatchUp::take(Octets octets) {
  const auto packet = pus::TelemetryView::parse(octets);
  if (!packet) return;
  if (!first_) first_ = packet->time();
  if (is_known(*packet, octets)) return;
  Heard heard = past_->take(*packet);
  // Who asked has long gone.
  heard.answer.reset();
  heard.mode_answer.reset();
  StoredPacket stored{.t = packet->time(), .apid = packet->apid(), .octets = {}};
  stored.service = packet->service();
  stored.subtype = packet->subtype();
  stored.sid = heard.sid;
  parts_.archive.add(stored, octets);
  for (const StoredChange& change : heard.changes) parts_.archive.add(change);
  if (heard.event) parts_.archive.add(*heard.event);
  parts_.heard(heard, packet->time());
}

void CatchUp::finish(const st129::RetrievalEnd& end) {
  if (end.request != request_) {
    // Of an earlier question, of the station before this one for example: what came until now was its.
    first_.reset();
    return;
  }
  const Wanted wanted = wanted_.front();
  const auto first = first_;
  past_.reset();
  // The next look asks again.
  if (!end.whole() && !end.why.empty() && wanted.tries < most_tries) return;
  wanted_.pop_front();
  // Where nothing came at all, the log is that of another flight.
  if (end.whole() && wanted.closes_gap && first) {
    parts_.archive.close_gaps({wanted.from, wanted.to});
    const bool all = wanted.after == After::TheBegin || *first - wanted.from < quiet;
    if (!all) parts_.archive.add(StoredGap{wanted.from, *first});
  }
  parts_.filled(wanted.from, wanted.to);
}

}  // namespace hirosco::ground
