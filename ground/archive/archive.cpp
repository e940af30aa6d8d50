// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/archive/archive.hpp"

#include "ground/archive/archive_file.hpp"

namespace hirosco::ground {

Archive::Archive(std::unique_ptr<ArchiveFile> file)
    : file_{std::move(file)},
      add_packet_{std::make_unique<SQLite::Statement>(
          file_->database(), "INSERT INTO packets(t, apid, service, subtype, sid, octets) VALUES(?, ?, ?, ?, ?, ?)")} {
  file_->wait_for_nobody();
}

Archive::~Archive() = default;

Result<std::unique_ptr<Archive>> Archive::open(const std::string& path, std::int64_t limit_octets) {
  HIROSCO_TRY_LET(auto file, ArchiveFile::open(path, limit_octets));
  try {
    return std::unique_ptr<Archive>{new Archive{std::move(file)}};
  } catch (const SQLite::Exception& refused) {
    return fail(ErrorCode::Malformed, "the archive is not one of ours", refused.getExtendedErrorCode());
  }
}

void Archive::commit() { file_->commit(); }
void Archive::keep_within_limit() { file_->keep_within_limit(); }
std::uint64_t Archive::failures() const noexcept { return file_->failures(); }

void Archive::add(const StoredPacket& packet, Octets octets) {
  file_->begin();
  file_->counted([&] {
    bind(*add_packet_, packet.t, packet.apid, packet.service, packet.subtype, packet.sid);
    add_packet_->bindNoCopy(6, octets.data(), static_cast<int>(octets.size()));
    add_packet_->exec();
  });
  static_cast<void>(add_packet_->tryReset());  // unfinished it would keep its lock
}

void Archive::add(const StoredEvent& event) {
  file_->store("INSERT INTO events(t, apid, subsystem, event, name, severity, text, vals) VALUES(?,?,?,?,?,?,?,?)",
               event.t, event.apid, event.subsystem, event.id, event.name, event.severity, event.text, event.values);
}

std::int64_t Archive::add(const StoredCommand& command) {
  const bool added = file_->store(
      "INSERT INTO commands(t, sender, apid, subsystem, function, arguments, stage, code, reason) "
      "VALUES(?,?,?,?,?,?,?,?,?)",
      command.t, command.sender, command.apid, command.subsystem, command.function, command.arguments, command.stage,
      command.code, command.reason);
  // The number of whatever was added last would give its reports to a stranger.
  return added ? file_->database().getLastInsertRowid() : 0;
}

void Archive::add(std::int64_t command, const StoredReport& report) {
  if (command == 0) return;
  if (file_->store("INSERT INTO reports(command, t, stage, code, reason) VALUES(?,?,?,?,?)", command, report.t,
                   report.stage, report.code, report.reason))
    file_->store("UPDATE commands SET stage=?, code=?, reason=? WHERE id=?", report.stage, report.code, report.reason,
                 command);
}

void Archive::add(const StoredChange& change) {
  file_->store("INSERT INTO changes(t, kind, name, value) VALUES(?,?,?,?)", change.t, change.kind, change.name,
               change.value);
}

void Archive::add(const StoredGap& gap) { file_->store("INSERT INTO gaps(t, until) VALUES(?,?)", gap.from, gap.to); }

void Archive::close_gaps(const Span& span) {
  file_->store("DELETE FROM gaps WHERE t >= ? AND until <= ?", span.from, span.to);
}

void Archive::add(const StoredFault& fault) {
  file_->store("INSERT INTO faults(t, device, line, answer) VALUES(?,?,?,?)", fault.t, fault.device, fault.line,
               fault.answer);
}

std::int64_t Archive::add(const StoredMark& mark) {
  const bool added = file_->store("INSERT INTO marks(t, kind, name, action, who, note, until) VALUES(?,?,?,?,?,?,?)",
                                  mark.t, mark.kind, mark.name, mark.action, mark.who, mark.note, mark.until);
  return added ? file_->database().getLastInsertRowid() : 0;
}

}  // namespace hirosco::ground
