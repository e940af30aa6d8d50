// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/ascii_database.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <concepts>
#include <deque>
#include <fstream>
#include <limits>
#include <set>
#include <span>
#include <system_error>
#include <utility>

#include "hirosco/utilities/crc32.hpp"

namespace hirosco::supervisor {

namespace {

/// A line holds at most a whole packet in hexadecimal and some 300 letters beside it.
constexpr std::size_t max_line = 2 * Database::max_packet_octets + 1024;
constexpr std::size_t checksum_letters = 10;  // " #" and eight digits
constexpr std::string_view version_words = "HIROSCO packet log, version ";
constexpr std::size_t longest_version_line = 1024;  // of a later version, too
constexpr std::string_view hex_digits = "0123456789abcdef";

std::uint32_t checksum_of(std::string_view text) { return crc32(std::as_bytes(std::span{text})); }

void add_hexadecimal(std::string& line, std::uint32_t value) {
  for (int shift = 28; shift >= 0; shift -= 4) line += hex_digits[(value >> shift) & 0xFU];
}

/// " #" and the checksum of all before it.
void seal(std::string& line) {
  const std::uint32_t checksum = checksum_of(line);
  line += " #";
  add_hexadecimal(line, checksum);
}

/// What is before the checksum; nothing: the line is cut or changed.
std::optional<std::string_view> unsealed(std::string_view line) {
  if (line.size() < checksum_letters) return std::nullopt;
  const std::string_view words = line.substr(0, line.size() - checksum_letters);
  std::string checksum = " #";
  add_hexadecimal(checksum, checksum_of(words));
  return line.substr(words.size()) == checksum ? std::optional{words} : std::nullopt;
}

std::string_view take_word(std::string_view& rest) {
  const std::size_t end = std::min(rest.find(' '), rest.size());
  const std::string_view word = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return word;
}

template <std::integral T>
bool take_number(std::string_view& rest, T& number) {
  const std::string_view word = take_word(rest);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc{} && end == word.data() + word.size() && !word.empty();
}

bool take_octets(std::string_view& rest, std::vector<std::byte>& octets) {
  const std::string_view word = take_word(rest);
  if (word == "-") return true;
  if (word.empty() || word.size() % 2 != 0) return false;
  octets.reserve(word.size() / 2);
  for (std::size_t i = 0; i < word.size(); i += 2) {
    const std::size_t high = hex_digits.find(word[i]);
    const std::size_t low = hex_digits.find(word[i + 1]);
    if (high == std::string_view::npos || low == std::string_view::npos) return false;
    octets.push_back(static_cast<std::byte>(high << 4 | low));
  }
  return true;
}

/// No space and no right are told apart from an error after which nobody knows what the file holds.
ErrorCode code_of(int reason) {
  if (reason == ENOSPC || reason == EDQUOT) return ErrorCode::ResourceExhausted;
  const bool forbidden = reason == EACCES || reason == EPERM || reason == EROFS || reason == ENOENT ||
                         reason == ENOTDIR || reason == EISDIR || reason == EMFILE || reason == ENFILE;
  return forbidden ? ErrorCode::NotPermitted : ErrorCode::SystemFailure;
}

Result<> write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return fail(code_of(errno), "writing the log file", errno);
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return ok();
}

/// A new file is only safe once its folder is.
Result<> sync_folder_of(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return fail(ErrorCode::SystemFailure, "opening the folder of the log file", errno);
  const int outcome = ::fsync(descriptor);
  const int reason = errno;
  ::close(descriptor);
  if (outcome != 0) return fail(ErrorCode::SystemFailure, "fsync of the folder of the log file", reason);
  return ok();
}

/// Whether a line that is not one of ours says another version. Whole, with words that only a later one knows, it does as well.
bool says_another_version(std::string_view line) {
  return line.starts_with(version_words) && unsealed(line) && version_from_ascii(line) != ascii_version;
}

/// What a file begins with says its version, or nothing does: what is there then is judged line by line.
Result<> check_version(std::string_view begin) {
  const std::string_view line = begin.substr(0, begin.find('\n'));
  if (!says_another_version(line)) return ok();
  return fail(ErrorCode::Mismatch, "log file of another version", version_from_ascii(line).value_or(0));
}

/// As much of it as says the version.
Result<std::string> read_begin_of_log(int descriptor) {
  std::string begin(longest_version_line, '\0');
  const ssize_t octets = ::pread(descriptor, begin.data(), begin.size(), 0);
  // What cannot be read at its begin, a pipe, says no version.
  if (octets < 0 && errno != ESPIPE) return fail(code_of(errno), "reading the begin of the log file", errno);
  begin.resize(static_cast<std::size_t>(std::max<ssize_t>(octets, 0)));
  return begin;
}

/// What has to stand before the next record: the version of an empty file, or what a crash has cut of it, or the end of a cut line.
std::string missing_before_next(int descriptor, std::string_view begin) {
  const off_t octets = ::lseek(descriptor, 0, SEEK_END);
  if (octets < 0) return {};
  const std::string version = ascii_version_line() + '\n';
  const auto there = static_cast<std::size_t>(octets);
  if (there == 0) return version;
  if (there < version.size() && version.starts_with(begin)) return version.substr(begin.size());
  char last{'\n'};
  return ::pread(descriptor, &last, 1, octets - 1) == 1 && last != '\n' ? "\n" : "";
}

}  // namespace

std::string ascii_version_line(std::uint32_t version) {
  std::string line = std::string{version_words} + std::to_string(version);
  seal(line);
  return line;
}

std::optional<std::uint32_t> version_from_ascii(std::string_view line) {
  if (!line.starts_with(version_words)) return std::nullopt;
  const auto words = unsealed(line);
  if (!words || words->size() < version_words.size()) return std::nullopt;
  std::string_view rest = words->substr(version_words.size());
  std::uint32_t version{};
  return take_number(rest, version) && rest.empty() ? std::optional{version} : std::nullopt;
}

std::string ascii_line(const LogRecord& record) {
  std::string line = std::to_string(record.number) + ' ' + time_text(record.run) + ' ' + time_text(record.stored) +
                     ' ' + std::to_string(record.monotonic.time_since_epoch().count()) + ' ' +
                     std::string{to_text(record.kind)} + ' ' + std::to_string(record.source) + ' ' +
                     std::to_string(record.peer) + ' ' + std::to_string(record.lost) + ' ';
  if (record.packet.empty()) line += '-';
  for (std::byte octet : record.packet) {
    line += hex_digits[std::to_integer<std::size_t>(octet) >> 4];
    line += hex_digits[std::to_integer<std::size_t>(octet) & 0xFU];
  }
  line.append(" ").append(record.note.view());
  seal(line);
  return line;
}

Result<LogRecord> record_from_ascii(std::string_view line) {
  const auto malformed = [](const char* what) { return fail(ErrorCode::Malformed, what); };
  const auto words = unsealed(line);
  if (!words) return malformed("log line is cut or differs from its checksum");
  std::string_view rest = *words;
  LogRecord record;
  std::int64_t monotonic{};
  if (!take_number(rest, record.number)) return malformed("number of a log line");
  HIROSCO_TRY_LET(record.run, time_from_text(take_word(rest)));
  HIROSCO_TRY_LET(record.stored, time_from_text(take_word(rest)));
  if (!take_number(rest, monotonic)) return malformed("monotonic time of a log line");
  record.monotonic = TimePoint{Duration{monotonic}};
  const auto kind = from_text<LogKind>(take_word(rest));
  if (!kind) return malformed("kind of a log line");
  record.kind = *kind;
  if (!take_number(rest, record.source) || !take_number(rest, record.peer) || !take_number(rest, record.lost))
    return malformed("parties of a log line");
  if (!take_octets(rest, record.packet)) return malformed("packet of a log line");
  record.note = Note{rest};
  return record;
}

Result<std::unique_ptr<Database>> AsciiDatabase::open(const std::filesystem::path& path, DatabaseAccess access) {
  if (access == DatabaseAccess::Read) {
    if (!std::filesystem::is_regular_file(path)) return fail(ErrorCode::NotFound, "no such log file");
    std::string begin(longest_version_line, '\0');
    std::ifstream file{path};
    file.read(begin.data(), std::ssize(begin));
    begin.resize(static_cast<std::size_t>(file.gcount()));
    HIROSCO_TRY(check_version(begin));
    return std::unique_ptr<Database>(new AsciiDatabase{path, -1});
  }
  const int descriptor = ::open(path.c_str(), O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0640);
  if (descriptor < 0) return fail(code_of(errno), "opening the log file", errno);
  std::unique_ptr<AsciiDatabase> database{new AsciiDatabase{path, descriptor}};
  HIROSCO_TRY_LET(const std::string begin, read_begin_of_log(descriptor));
  HIROSCO_TRY(check_version(begin));
  database->missing_ = missing_before_next(descriptor, begin);
  HIROSCO_TRY(sync_folder_of(path));
  return database;
}

AsciiDatabase::~AsciiDatabase() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

/// The version goes with the first batch in one write: until then the file is an empty one.
Result<> AsciiDatabase::do_append(std::span<const LogRecord> batch) {
  if (descriptor_ < 0) return fail(ErrorCode::NotPermitted, "this log is open for reading only");
  text_ = missing_;
  for (const LogRecord& record : batch) text_.append(ascii_line(record)) += '\n';
  HIROSCO_TRY(write_all(descriptor_, text_));
  if (::fdatasync(descriptor_) != 0) return fail(ErrorCode::SystemFailure, "fdatasync of the log file", errno);
  missing_.clear();
  return ok();
}

Result<LogPage> AsciiDatabase::do_read(const LogQuery& query) {
  std::ifstream file{path_};
  if (!file) return fail(ErrorCode::NotFound, "no such log file");
  LogPage page;
  std::deque<LogRecord> found;
  std::set<std::pair<OnboardTime, std::uint64_t>> seen;
  std::vector<char> buffer(max_line + 1);
  bool foreign = false;  // behind the version of another one: pieces were put behind each other
  std::error_code failed;
  const std::uint64_t octets = query.tail_octets != 0 ? std::filesystem::file_size(path_, failed) : 0;
  if (!failed && octets > query.tail_octets) {
    file.seekg(static_cast<std::streamoff>(octets - query.tail_octets));
    file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');  // the rest of a line
  }
  while (file.getline(buffer.data(), std::ssize(buffer)) || file.gcount() > 0) {
    if (file.fail() && !file.eof()) {  // longer than any line of ours
      file.clear();
      file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
      ++page.damaged;
      continue;
    }
    const std::string_view line{buffer.data(), static_cast<std::size_t>(file.gcount()) - (file.eof() ? 0U : 1U)};
    if (line.empty()) continue;
    if (version_from_ascii(line) == ascii_version) {
      foreign = false;
      continue;
    }
    foreign = foreign || says_another_version(line);
    auto record = record_from_ascii(line);
    if (foreign || !record) {
      ++page.damaged;
      continue;
    }
    if (!matches(*record, query) || !seen.emplace(record->run, record->number).second) continue;
    found.push_back(std::move(*record));
    if (query.end == LogEnd::Oldest && found.size() == query.last) break;
    if (found.size() <= query.last) continue;
    seen.erase({found.front().run, found.front().number});
    found.pop_front();
  }
  page.records.assign(std::make_move_iterator(found.begin()), std::make_move_iterator(found.end()));
  return page;
}

}  // namespace hirosco::supervisor
