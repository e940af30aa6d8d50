// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/database.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <utility>

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/utilities/lower_case.hpp"
#include "supervisor/platform/storage/ascii_database.hpp"
#include "supervisor/platform/storage/sqlite_database.hpp"

namespace hirosco::supervisor {

namespace {

using Days = std::chrono::sys_days;
using UnixNanoseconds = std::chrono::sys_time<Duration>;
constexpr std::chrono::seconds epoch_offset{onboard_epoch_to_unix_s};

std::string party(std::uint16_t apid) { return apid == 0 ? "ground" : std::to_string(apid); }

/// Takes a decimal number of exactly `digits` digits from the front of `text`.
std::optional<std::int64_t> take_digits(std::string_view& text, std::size_t digits, char after) {
  if (text.size() < digits + (after != '\0' ? 1 : 0)) return std::nullopt;
  std::int64_t number{};
  const char* const first = text.data();
  const auto [end, error] = std::from_chars(first, first + digits, number);
  if (error != std::errc{} || end != first + digits || number < 0) return std::nullopt;
  text.remove_prefix(digits);
  if (after == '\0') return number;
  if (text.front() != after) return std::nullopt;
  text.remove_prefix(1);
  return number;
}

}  // namespace

PacketLabel label_of(Octets packet) noexcept {
  const auto header = pus::read_primary_header(packet);
  if (!header) return {};
  PacketLabel label{.telecommand = header->telecommand, .apid = header->apid};
  // Telecommands and telemetry alike carry service and subtype behind the first octet of the secondary header.
  constexpr std::size_t service_offset = pus::primary_header_octets + 1;
  if (!header->secondary_header || packet.size() < service_offset + 2) return label;
  label.service = std::to_integer<std::uint8_t>(packet[service_offset]);
  label.subtype = std::to_integer<std::uint8_t>(packet[service_offset + 1]);
  return label;
}

std::string time_text(OnboardTime time) {
  const UnixNanoseconds unix_time{time.time_since_epoch() - epoch_offset};
  const Days day = std::chrono::floor<std::chrono::days>(unix_time);
  const std::chrono::year_month_day date{day};
  const std::chrono::hh_mm_ss<Duration> clock{unix_time - day};
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%04d-%02u-%02uT%02d:%02d:%02d.%09lld", static_cast<int>(date.year()),
                static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                static_cast<int>(clock.hours().count()), static_cast<int>(clock.minutes().count()),
                static_cast<int>(clock.seconds().count()), static_cast<long long>(clock.subseconds().count()));
  return text.data();
}

Result<OnboardTime> time_from_text(std::string_view text) {
  const auto year = take_digits(text, 4, '-');
  const auto month = take_digits(text, 2, '-');
  const auto day = take_digits(text, 2, 'T');
  const auto hour = take_digits(text, 2, ':');
  const auto minute = take_digits(text, 2, ':');
  const auto second = take_digits(text, 2, '.');
  const auto fraction = take_digits(text, 9, '\0');
  if (!year || !month || !day || !hour || !minute || !second || !fraction || !text.empty())
    return fail(ErrorCode::Malformed, "not a time of the form 2026-01-01T00:00:00.000000000");
  const std::chrono::year_month_day date{std::chrono::year{static_cast<int>(*year)},
                                         std::chrono::month{static_cast<unsigned>(*month)},
                                         std::chrono::day{static_cast<unsigned>(*day)}};
  if (!date.ok() || *hour > 23 || *minute > 59 || *second > 59 || *year < 1700 || *year > 2240)
    return fail(ErrorCode::Malformed, "no such time");
  const Duration since_unix = Days{date}.time_since_epoch() + std::chrono::hours{*hour} +
                              std::chrono::minutes{*minute} + std::chrono::seconds{*second} + Duration{*fraction};
  return OnboardTime{since_unix + epoch_offset};
}

std::string describe(const LogRecord& record) {
  std::string line =
      std::to_string(record.number) + ' ' + time_text(record.stored) + ' ' + std::string{to_text(record.kind)};
  if (record.kind == LogKind::Gap) line += ' ' + std::to_string(record.lost) + " records lost";
  else line += ' ' + party(record.source) + '>' + party(record.peer);
  if (!record.packet.empty()) {
    const PacketLabel label = label_of(record.packet);
    line += label.telecommand ? " TC[" : " TM[";
    line += std::to_string(label.service) + ',' + std::to_string(label.subtype) + "] " +
            std::to_string(record.packet.size()) + " octets";
  }
  if (!record.note.view().empty()) line.append(": ").append(record.note.view());
  return line;
}

std::uint64_t last_lost(const LogRecord& gap) noexcept {
  constexpr std::string_view before = "up to number ";
  const std::string_view note = gap.note.view();
  std::uint64_t last = 0;
  if (const std::size_t at = note.rfind(before); at != std::string_view::npos)
    std::from_chars(note.data() + at + before.size(), note.data() + note.size(), last);
  return std::max(last, gap.number + std::max(gap.lost, 1U) - 1);
}

bool matches(const LogRecord& record, const LogQuery& query) {
  if (record.number < query.since) return false;
  if (query.run && record.run != *query.run) return false;
  if (record.stored < query.stored_from || record.stored > query.stored_to) return false;
  if (query.kind && record.kind != *query.kind) return false;
  const PacketLabel label = label_of(record.packet);
  if (query.apid && record.source != *query.apid && record.peer != *query.apid &&
      (record.packet.empty() || label.apid != *query.apid))
    return false;
  if (query.service && (record.packet.empty() || label.service != *query.service)) return false;
  const bool housekeeping = !record.packet.empty() && !label.telecommand && label.service == 3 && label.subtype == 25;
  if (housekeeping && !query.housekeeping) return false;
  if (query.text.empty()) return true;
  const std::string words = query.words ? query.words(record) : describe(record);
  return lower_case(words).find(lower_case(query.text)) != std::string::npos;
}

Result<> Database::append(std::span<const LogRecord> batch) {
  if (failed_) return fail(*failed_);
  for (const LogRecord& record : batch)
    if (record.packet.size() > max_packet_octets)
      return fail(ErrorCode::OutOfRange, "packet longer than a space packet", std::ssize(record.packet));
  if (batch.empty()) return ok();
  Result<> outcome = do_append(batch);
  if (!outcome && outcome.error().code != ErrorCode::Unavailable) failed_ = outcome.error();
  return outcome;
}

Result<> MemoryDatabase::do_append(std::span<const LogRecord> batch) {
  const std::lock_guard lock{mutex_};
  const std::size_t before = records_.size();
  for (const LogRecord& record : batch) {
    // Records come in the order of their numbers, so that a repeated one is found near the end.
    const auto same = std::find_if(records_.rbegin(), records_.rend(), [&](const LogRecord& old) {
      return old.run != record.run || old.number <= record.number;
    });
    if (same == records_.rend() || same->run != record.run || same->number != record.number) {
      records_.push_back(record);
    } else if (*same != record) {
      records_.resize(before);
      return fail(ErrorCode::AlreadyExists, "another record has this number", static_cast<std::int64_t>(record.number));
    }
  }
  return ok();
}

Result<LogPage> MemoryDatabase::do_read(const LogQuery& query) {
  const std::lock_guard lock{mutex_};
  LogPage page;
  if (query.end == LogEnd::Oldest) {
    for (auto record = records_.begin(); record != records_.end() && page.records.size() < query.last; ++record)
      if (matches(*record, query)) page.records.push_back(*record);
    return page;
  }
  for (auto record = records_.rbegin(); record != records_.rend() && page.records.size() < query.last; ++record)
    if (matches(*record, query)) page.records.push_back(*record);
  std::ranges::reverse(page.records);
  return page;
}

Result<std::unique_ptr<Database>> open_database(DatabaseStrategy strategy, const std::filesystem::path& path,
                                                DatabaseAccess access) {
  switch (strategy) {
    case DatabaseStrategy::Sqlite: return SqliteDatabase::open(path, access);
    case DatabaseStrategy::Ascii: return AsciiDatabase::open(path, access);
    case DatabaseStrategy::Postgresql: break;
    case DatabaseStrategy::Memory: return std::make_unique<MemoryDatabase>();
  }
  return fail(ErrorCode::InvalidArgument, "no such database strategy for a path", std::to_underlying(strategy));
}

}  // namespace hirosco::supervisor
