// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: log writer (docs/safety/modules.csv).
#include "supervisor/platform/storage/log_queue.hpp"

#include <algorithm>
#include <cassert>
#include <string>

namespace hirosco::supervisor {

namespace {
[[nodiscard]] std::uint32_t told_as_lost(std::uint64_t numbers) noexcept {
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(numbers, UINT32_MAX));
}

/// The share of the ring of telecommands and events that only events and actions may use: a quarter.
constexpr std::size_t reserve_divisor = 4;

bool may_use_reserve(LogKind kind) {
  return kind == LogKind::Event || kind == LogKind::Action || kind == LogKind::Switched;
}
}  // namespace

bool may_be_lost(const LogEntry& entry) noexcept {
  if (entry.kind == LogKind::Telemetry) return true;
  if (entry.kind != LogKind::Event) return false;
  const PacketLabel label = label_of(entry.packet);
  // TM[5,1] info and TM[5,2] low; an event without a packet is the supervisor's own and is kept.
  return label.service == 5 && (label.subtype == 1 || label.subtype == 2);
}

LogRecord& LogBatch::add(std::size_t packet_octets) {
  assert(!full());
  LogRecord& record = records_[used_++];
  record.lost = 0;
  kept_octets_ -= record.packet.capacity();
  record.packet.resize(packet_octets);
  kept_octets_ += record.packet.capacity();
  octets_ += packet_octets;
  return record;
}

void LogBatch::clear() noexcept {
  used_ = 0;
  octets_ = 0;
  // Each place would keep the room of the longest packet that it ever had.
  if (kept_octets_ <= most_kept_octets) return;
  for (LogRecord& record : records_) record.packet = std::vector<std::byte>{};
  kept_octets_ = 0;
}

LogQueue::Ring::Ring(std::size_t records, std::size_t octets)
    : headers_(std::max<std::size_t>(records, 1)), octets_(std::max<std::size_t>(octets, 1)) {}

bool LogQueue::Ring::fits(std::size_t octets, std::size_t divisor) const noexcept {
  const auto usable = [divisor](std::size_t all) { return divisor == 0 ? all : all - all / divisor; };
  return size() < usable(headers_.size()) && used_octets_ + octets <= usable(octets_.size());
}

void LogQueue::Ring::push(const Header& header, Octets packet) noexcept {
  headers_[back_++ % headers_.size()] = header;
  const std::size_t start = (first_octet_ + used_octets_) % octets_.size();
  const std::size_t first_part = std::min(packet.size(), octets_.size() - start);
  copy_octets(packet.first(first_part), MutableOctets{octets_}.subspan(start));
  copy_octets(packet.subspan(first_part), octets_);
  used_octets_ += packet.size();
}

void LogQueue::Ring::read_front(MutableOctets packet) const noexcept {
  const std::size_t first_part = std::min(packet.size(), octets_.size() - first_octet_);
  const Octets all{octets_};
  copy_octets(all.subspan(first_octet_, first_part), packet);
  copy_octets(all.first(packet.size() - first_part), MutableOctets{packet}.subspan(first_part));
}

void LogQueue::Ring::pop() noexcept {
  const std::size_t octets = front().octets;
  ++front_;
  first_octet_ = (first_octet_ + octets) % octets_.size();
  used_octets_ -= octets;
}

LogQueue::LogQueue(const Limits& limits, OnboardTime run)
    : run_{run},
      telemetry_{limits.telemetry_records, limits.telemetry_octets},
      vital_{limits.vital_records, limits.vital_octets} {}

void LogQueue::resume(const LogResumption& from, OnboardTime stored, TimePoint monotonic) {
  run_ = from.run;
  last_number_ = from.last;
  if (from.last <= from.durable) return;
  const std::uint64_t missing = from.last - from.durable;
  lost_ = missing;
  inherited_ = Gap{.first = from.durable + 1,
                   .last = from.last,
                   .lost = told_as_lost(missing),
                   .stored = stored,
                   .monotonic = monotonic};
}

void LogQueue::found_on_disk(std::uint64_t durable) noexcept {
  if (!inherited_ || durable < inherited_->first) return;
  const std::uint64_t found = std::min(durable, inherited_->last);
  lost_ -= found - inherited_->first + 1;
  inherited_->first = found + 1;
  inherited_->lost = told_as_lost(inherited_->last - found);
  if (found == inherited_->last) inherited_.reset();
}

std::uint64_t LogQueue::push(const LogEntry& entry, OnboardTime stored, TimePoint monotonic) {
  const std::uint64_t number = ++last_number_;
  if (!make_room(entry)) {
    miss(number, stored, monotonic);
    ++refused_;
    return 0;
  }
  const bool vital = !may_be_lost(entry);
  if (vital && !entry.may_wait) newest_urgent_ = number;
  Ring& ring = vital ? vital_ : telemetry_;
  ring.push({.number = number,
             .stored = stored,
             .monotonic = monotonic,
             .kind = entry.kind,
             .source = entry.source,
             .peer = entry.peer,
             .note = entry.note,
             .octets = entry.packet.size()},
            entry.packet);
  return number;
}

bool LogQueue::make_room(const LogEntry& entry) {
  const std::size_t octets = entry.packet.size();
  if (octets > Database::max_packet_octets) return false;
  if (!may_be_lost(entry)) return vital_.fits(octets, may_use_reserve(entry.kind) ? 0 : reserve_divisor);
  if (!telemetry_.could_ever_fit(octets)) return false;
  while (!telemetry_.fits(octets, 0)) {
    const Header& oldest = telemetry_.front();
    miss(oldest.number, oldest.stored, oldest.monotonic);
    ++lost_;
    telemetry_.pop();
  }
  return true;
}

void LogQueue::miss(std::uint64_t number, OnboardTime stored, TimePoint monotonic) {
  if (!gap_) gap_ = Gap{.first = number, .last = number, .lost = 0, .stored = stored, .monotonic = monotonic};
  // A refused record may be followed by the loss of an older one.
  if (number < gap_->first) {
    gap_->first = number;
    gap_->stored = stored;
    gap_->monotonic = monotonic;
  }
  gap_->last = std::max(gap_->last, number);
  ++gap_->lost;
}

std::uint64_t LogQueue::next_waiting() const noexcept {
  if (inherited_) return inherited_->first;
  std::uint64_t next = gap_ ? gap_->first : none;
  if (telemetry_.size() != 0) next = std::min(next, telemetry_.front().number);
  if (vital_.size() != 0) next = std::min(next, vital_.front().number);
  return next;
}

void LogQueue::take(LogBatch& batch, std::size_t count, std::uint64_t up_to) {
  for (; count > 0 && !batch.full(); --count) {
    const std::uint64_t next = next_waiting();
    if (next == none || next > up_to) return;
    if (inherited_) {
      take_gap(*inherited_, "the supervisor died before they were on the disk", batch);
      inherited_.reset();
    } else if (gap_ && gap_->first == next) {
      take_gap(*gap_, "no room before the database", batch);
      gap_.reset();
    } else if (vital_.size() != 0 && vital_.front().number == next) {
      take_from(vital_, batch);
    } else {
      take_from(telemetry_, batch);
    }
  }
}

void LogQueue::take_gap(const Gap& gap, std::string_view why, LogBatch& batch) const {
  LogRecord& record = batch.add(0);
  record.run = run_;
  record.number = gap.first;
  record.stored = gap.stored;
  record.monotonic = gap.monotonic;
  record.kind = LogKind::Gap;
  record.source = 0;
  record.peer = 0;
  record.lost = gap.lost;
  record.note = Note{std::string{why} + ", up to number " + std::to_string(gap.last)};
}

void LogQueue::take_from(Ring& ring, LogBatch& batch) {
  const Header& header = ring.front();
  LogRecord& record = batch.add(header.octets);
  record.run = run_;
  record.number = header.number;
  record.stored = header.stored;
  record.monotonic = header.monotonic;
  record.kind = header.kind;
  record.source = header.source;
  record.peer = header.peer;
  record.note = header.note;
  ring.read_front(record.packet);
  ring.pop();
}

}  // namespace hirosco::supervisor
