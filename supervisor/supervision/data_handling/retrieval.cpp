// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/retrieval.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace hirosco::supervisor {

namespace st129 = pus::st129;

namespace {
/// 7 octets say 2^-24 s.
constexpr Duration cut_off = 60ns;

void add(std::uint32_t& sum, std::uint64_t count) {
  sum = static_cast<std::uint32_t>(std::min<std::uint64_t>(sum + count, UINT32_MAX));
}
}  // namespace

void Retrieval::begin(const pus::Request& asked, Octets data) {
  pus::Verification& verification = parts_.own.verification();
  const auto wanted = st129::read_retrieve(data);
  if (!wanted || wanted->to < wanted->from)
    return verification.rejected(asked, pus::FailureNotice{pus::FailureCode::IllegalField});
  verification.accepted(asked);
  if (parts_.readings == nullptr) {
    pus::FailureNotice none{pus::FailureCode::NotPermittedNow};
    return verification.start_failed(asked, none.because({ErrorCode::Unavailable, 0, "this deployment reads no log"}));
  }
  if (running_ && running_->destination != asked.source)
    return verification.start_failed(asked, pus::FailureNotice{pus::FailureCode::Busy});
  // Its own number is where it ends: what follows is said now, to whoever listens.
  const std::uint64_t through = parts_.craft.log.append(
      {.kind = LogKind::Action, .source = supervisor_apid, .note = "what was said before is sent down again"});
  if (through == 0) return verification.start_failed(asked, pus::FailureNotice{pus::FailureCode::QueueFull});
  if (running_) finish("asked anew");
  verification.started(asked);
  running_ = Running{.wanted = *wanted, .destination = asked.source, .through = through, .begun = parts_.craft.now};
  running_->end.request = asked.id;
  verification.completed(asked);
}

void Retrieval::watch(TimePoint now) {
  if (!running_ && !abandoned_) return;
  if (auto page = parts_.readings->outcome()) {
    const bool wanted = !std::exchange(abandoned_, false) && running_;
    if (wanted) running_->reads = false;
    if (wanted && !*page) return finish("the log cannot be read: " + std::string{page->error().text});
    if (wanted) take(*running_, **page);
  }
  if (!running_) return;
  send(*running_);
  if (!running_->page.empty()) return;
  if (running_->what == Reads::Nothing) return finish({});
  read_on(*running_, now);
}

void Retrieval::take(Running& running, LogPage& page) const {
  pus::st129::RetrievalEnd& end = running.end;
  if (running.what == Reads::Reports) {
    end.damaged += static_cast<std::uint32_t>(page.damaged);
    const bool all = page.records.size() < page_records;
    for (LogRecord& record : page.records) {
      look_for_skipped(running, record);
      running.page.push_back(std::move(record));
    }
    if (!running.page.empty()) running.next = running.page.back().number + 1;
    if (all || running.next > running.through) running.what = Reads::Gaps;
  } else if (running.what == Reads::Gaps) {
    for (LogRecord& gap : page.records) {
      if (gap.number > running.through) continue;
      if (gap.stored < running.wanted.from) running.early.push_back(std::move(gap));
      else add(end.missing, gap.lost);
    }
    running.what = running.early.empty() ? Reads::First : Reads::Before;
  } else if (running.what == Reads::Before) {
    std::uint64_t before = page.records.empty() ? 0 : page.records.back().number;
    if (before != 0 && page.records.back().kind == LogKind::Gap) --before;  // how far that one reaches it alone says
    for (const LogRecord& gap : running.early)
      if (const std::uint64_t last = last_lost(gap); last > before)
        add(end.missing, std::min<std::uint64_t>(gap.lost, last - before));
    running.what = Reads::First;
  } else {
    miss_what_was_before(running, page);
    running.what = Reads::Nothing;
  }
}

/// Where all records of a time are read each number stands there: what is in between is gone, whether a gap tells of it or not.
void Retrieval::look_for_skipped(Running& running, const LogRecord& record) {
  if (!running.wanted.housekeeping || record.number <= running.seen || record.number > running.through) return;
  if (running.seen != 0) running.skipped += record.number - running.seen - 1;
  if (record.kind == LogKind::Gap) ++running.skipped;  // which stands under one of them
  running.seen = record.number;
}

/// The numbers of a flight begin with 1: those before the first that is there were removed, nobody knows of which times.
void Retrieval::miss_what_was_before(Running& running, const LogPage& first) const {
  add(running.end.missing, running.skipped - std::min<std::uint64_t>(running.skipped, running.end.missing));
  const bool none = first.records.empty();
  if (running.wanted.to + cut_off < parts_.craft.log.run()) return;
  if (!none && first.records.front().stored < running.wanted.from) return;
  add(running.end.missing, (none ? running.through + 1 : first.records.front().number) - 1);
}

LogQuery Retrieval::query_of(const Running& running) const {
  LogQuery query{.run = parts_.craft.log.run(),
                 .stored_from = running.wanted.from,
                 .stored_to = running.wanted.to + cut_off,
                 .last = page_records,
                 .end = LogEnd::Oldest};
  if (running.what == Reads::Reports) {
    query.housekeeping = running.wanted.housekeeping;
    query.since = running.next;
    return query;
  }
  if (running.what == Reads::First) return {.run = query.run, .last = 1, .end = LogEnd::Oldest};
  // The times of a gap are those of its first record, and a log that is deleted meanwhile begins with one.
  query.stored_from = OnboardTime::min();
  query.end = LogEnd::Newest;
  query.last = 1;
  if (running.what == Reads::Before) {
    query.stored_to = running.wanted.from - 1ns;
  } else {
    query.kind = LogKind::Gap;
    query.last = most_gaps;
  }
  return query;
}

void Retrieval::read_on(Running& running, TimePoint now) {
  if (running.reads || abandoned_) return;
  PacketLog& log = parts_.craft.log;
  if (log.durable() < running.through) {
    if (now - running.begun >= disk_patience) finish("what was said last is not on the disk yet");
    return;
  }
  const auto begun = parts_.readings->begin(query_of(running));
  if (begun) running.reads = true;
  else finish(begun.error().text);
}

void Retrieval::send(Running& running) {
  std::array<std::byte, st129::max_retrieved_octets + sizeof(std::uint64_t)> buffer;
  for (std::size_t sent = 0; sent < most_at_once && !running.page.empty();) {
    // What this step has said is ahead of it; a link that does not take all is not filled. (What this step has said is no reason to wait:
    // of a stream that says something in each, it would be for ever.)
    if (parts_.telemetry.ground().behind()) return;
    const LogRecord record = std::move(running.page.front());
    running.page.pop_front();
    if (record.number > running.through) continue;
    if (record.kind != LogKind::Telemetry && record.kind != LogKind::Event) continue;
    const Octets data = st129::write_retrieved(buffer, {record.number, record.packet});
    if (data.empty()) {
      ++running.end.left_out;
      continue;
    }
    parts_.own.telemetry().report(st129::service_type, st129::retrieved, running.destination, data);
    ++running.end.reports;
    ++sent;
  }
}

void Retrieval::finish(std::string why) {
  running_->end.why = std::move(why);
  parts_.own.telemetry().report(st129::service_type, st129::retrieval_end, running_->destination,
                                st129::write_retrieval_end(running_->end));
  abandoned_ = abandoned_ || running_->reads;  // asked anew twice: the page of the first may be under way still
  running_.reset();
}

}  // namespace hirosco::supervisor
