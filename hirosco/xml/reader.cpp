// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/xml/reader.hpp"

#include <expat.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include "hirosco/utilities/utf8.hpp"

namespace hirosco::xml {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

constexpr bool is_space(char c) noexcept { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
constexpr bool is_continuation(char c) noexcept { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

/// Turns octet offsets into lines and columns. Offsets only grow, so all calls together pass the document once.
class Cursor {
 public:
  explicit Cursor(std::string_view document) noexcept
      : document_{document}, offset_{document.starts_with(byte_order_mark) ? byte_order_mark.size() : 0} {}

  Position at(std::size_t offset) noexcept {
    for (; offset_ < offset && offset_ < document_.size(); ++offset_) {
      if (document_[offset_] == '\n') {
        ++position_.line;
        position_.column = 1;
      } else if (!is_continuation(document_[offset_])) {
        ++position_.column;
      }
    }
    if (offset_ >= document_.size() || !is_continuation(document_[offset_])) return position_;
    return {position_.line, position_.column > 1 ? position_.column - 1 : 1};
  }

 private:
  std::string_view document_;
  std::size_t offset_;
  Position position_{1, 1};
};

/// What must hold before Expat sees the first octet.
std::optional<Problem> refuse_octets(std::string_view document) {
  if (document.size() > max_document_octets)
    return Problem{Refusal::TooLarge, {1, 1}, "the document is larger than 4 MiB"};
  for (std::size_t i = 0; i < document.size();) {
    if (document[i] == '\0')
      return Problem{Refusal::NotWellFormed, Cursor{document}.at(i), "a NUL octet is not allowed"};
    const std::size_t octets = character_octets(document.substr(i));
    if (octets == 0) return Problem{Refusal::NotWellFormed, Cursor{document}.at(i), "invalid UTF-8"};
    i += octets;
  }
  return std::nullopt;
}

bool begins_with(std::string_view encoding, std::string_view name) noexcept {
  if (encoding.size() < name.size()) return false;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = encoding[i] >= 'a' && encoding[i] <= 'z' ? static_cast<char>(encoding[i] - 'a' + 'A') : encoding[i];
    if (c != name[i]) return false;
  }
  return true;
}

bool is_ascii(std::string_view document) noexcept {
  return std::ranges::all_of(document, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

/// Whether the octets of the document are by this encoding what they are as UTF-8. Old programs declare what they might have written.
bool means_utf8(std::string_view encoding, std::string_view document) noexcept {
  for (const std::string_view name : {"UTF-8", "US-ASCII"})
    if (encoding.size() == name.size() && begins_with(encoding, name)) return true;
  for (const std::string_view family : {"ISO-8859-", "WINDOWS-125"})
    if (begins_with(encoding, family)) return is_ascii(document);
  return false;
}

}  // namespace

/// Expat pushes, we are asked: each handler suspends it and leaves its events in a short queue.
class Reader::Parser {
 public:
  explicit Parser(std::string_view document)
      : document_{document}, cursor_{document}, expat_{XML_ParserCreate("UTF-8")} {
    problem_ = refuse_octets(document);
    if (expat_ == nullptr) problem_ = Problem{Refusal::TooLarge, {1, 1}, "no memory for the parser"};
    if (problem_) return;
    XML_SetUserData(expat_, this);
    XML_SetElementHandler(expat_, start, end);
    XML_SetCharacterDataHandler(expat_, text);
    XML_SetStartDoctypeDeclHandler(expat_, doctype);
    XML_SetXmlDeclHandler(expat_, declaration);
  }
  ~Parser() { XML_ParserFree(expat_); }
  Parser(const Parser&) = delete;
  Parser& operator=(const Parser&) = delete;

  std::expected<Event, Problem> next() {
    while (events_.empty()) {
      if (problem_) return std::unexpected(*problem_);
      if (finished_) return Event{};
      run();
    }
    Event event = std::move(events_.front());
    events_.pop_front();
    return event;
  }

 private:
  static Parser& self(void* data) noexcept { return *static_cast<Parser*>(data); }
  static void start(void* data, const XML_Char* name, const XML_Char** attributes) {
    self(data).on_start(name, attributes);
  }
  static void end(void* data, const XML_Char* name) { self(data).on_end(name); }
  static void text(void* data, const XML_Char* octets, int count) {
    self(data).on_text({octets, static_cast<std::size_t>(count)});
  }
  static void doctype(void* data, const XML_Char*, const XML_Char*, const XML_Char*, int) {
    Parser& parser = self(data);
    // Expat is already at the internal subset; people look for the beginning.
    const std::size_t begin = parser.document_.rfind("<!DOCTYPE", parser.offset());
    parser.refuse(Refusal::NotAllowed, "document type declarations and entities are not allowed", begin);
  }
  static void declaration(void* data, const XML_Char* /*version*/, const XML_Char* encoding, int) {
    if (encoding != nullptr && !means_utf8(encoding, self(data).document_))
      self(data).refuse(Refusal::NotAllowed, "the encoding must be UTF-8, or another one of which only ASCII is used");
  }

  [[nodiscard]] std::size_t offset() const noexcept {
    const XML_Index index = XML_GetCurrentByteIndex(expat_);
    return index < 0 ? 0 : static_cast<std::size_t>(index);
  }

  void run() {
    const XML_Status status = started_ ? XML_ResumeParser(expat_)
                                       : XML_Parse(expat_, document_.data(), static_cast<int>(document_.size()), 1);
    started_ = true;
    if (status == XML_STATUS_SUSPENDED || problem_) return;
    if (status == XML_STATUS_OK) {
      finished_ = true;
      return;
    }
    problem_ = Problem{Refusal::NotWellFormed, cursor_.at(offset()), reason(XML_GetErrorCode(expat_))};
  }

  /// Expat's words and, where it helps, the element that is open: people look for the tag that they forgot.
  [[nodiscard]] std::string reason(XML_Error error) const {
    std::string text = XML_ErrorString(error);
    const bool closing = error == XML_ERROR_TAG_MISMATCH;
    if (open_.empty() || (!closing && error != XML_ERROR_NO_ELEMENTS && error != XML_ERROR_UNCLOSED_TOKEN)) return text;
    const auto& [name, at] = open_.back();
    const std::string where =
        "<" + shortened(name) + ">, opened in " + std::to_string(at.line) + ":" + std::to_string(at.column);
    if (!closing) return text + ": the document ends inside " + where;
    const std::string_view rest = document_.substr(std::min(offset(), document_.size()));
    return text + ": </" + shortened(rest.substr(0, rest.find_first_of("> \t\r\n"))) + "> stands where " + where +
           ", is to be closed";
  }

  static std::string shortened(std::string_view name) {
    constexpr std::size_t most = 64;
    std::size_t end = std::min(name.size(), most);
    while (end < name.size() && end > 0 && is_continuation(name[end])) --end;
    return std::string{name.substr(0, end)};
  }

  void refuse(Refusal refusal, const char* reason) { refuse(refusal, reason, offset()); }
  void refuse(Refusal refusal, const char* reason, std::size_t where) {
    if (problem_) return;
    problem_ = Problem{refusal, cursor_.at(where), reason};
    XML_StopParser(expat_, XML_FALSE);
  }

  void suspend() {
    XML_ParsingStatus status{};
    XML_GetParsingStatus(expat_, &status);
    if (status.parsing == XML_PARSING) XML_StopParser(expat_, XML_TRUE);
  }

  void on_start(const XML_Char* name, const XML_Char** attributes) {
    if (problem_) return;
    give_text();
    if (open_.size() == max_depth) return refuse(Refusal::TooLarge, "elements are nested deeper than 64");
    Event event{.kind = Event::Kind::Start, .name = name, .attributes = {}, .text = {}, .at = cursor_.at(offset())};
    open_.emplace_back(event.name, event.at);
    std::size_t place = offset() + 1 + event.name.size();
    for (; *attributes != nullptr; attributes += 2) {
      if (event.attributes.size() == max_attributes)
        return refuse(Refusal::TooLarge, "the element has more than 256 attributes");
      Attribute attribute{attributes[0], attributes[1], {}, {}};
      if (attribute.value.size() > max_attribute_octets)
        return refuse(Refusal::TooLarge, "an attribute is longer than 64 KiB");
      place = locate(attribute, place);
      event.attributes.push_back(std::move(attribute));
    }
    events_.push_back(std::move(event));
    suspend();
  }

  /// Finds the attribute that begins after `place` in the raw octets; returns the place after its closing quote.
  /// Expat gives attributes in document order, and the tag is known to be well-formed.
  std::size_t locate(Attribute& attribute, std::size_t place) noexcept {
    const auto skip_to = [&](auto wanted) {
      while (place < document_.size() && !wanted(document_[place])) ++place;
    };
    skip_to([](char c) { return !is_space(c); });
    attribute.at = cursor_.at(place);
    skip_to([](char c) { return c == '"' || c == '\''; });
    const char quote = place < document_.size() ? document_[place] : '"';
    ++place;
    attribute.value_at = cursor_.at(place);
    skip_to([quote](char c) { return c == quote; });
    return place + 1;
  }

  void on_end(const XML_Char* name) {
    if (problem_) return;
    give_text();
    open_.pop_back();
    events_.push_back(
        {.kind = Event::Kind::End, .name = name, .attributes = {}, .text = {}, .at = cursor_.at(offset())});
    suspend();
  }

  void on_text(std::string_view octets) {
    if (problem_) return;
    if (!text_at_) {
      for (std::size_t i = 0; i < octets.size() && !text_at_; ++i)
        if (!is_space(octets[i])) text_at_ = cursor_.at(offset() + i);
      if (!text_at_) return;
    }
    text_.append(octets);
  }

  void give_text() {
    if (!text_at_) return;
    events_.push_back({.kind = Event::Kind::Text,
                       .name = {},
                       .attributes = {},
                       .text = std::exchange(text_, {}),
                       .at = *std::exchange(text_at_, std::nullopt)});
  }

  std::string_view document_;
  Cursor cursor_;
  XML_Parser expat_;
  std::optional<Problem> problem_;
  std::deque<Event> events_;
  std::string text_;
  std::optional<Position> text_at_;
  std::vector<std::pair<std::string, Position>> open_;  ///< elements, the innermost last
  bool started_{false};
  bool finished_{false};
};

Reader::Reader(std::string_view document) : parser_{std::make_unique<Parser>(document)} {}
Reader::~Reader() = default;
Reader::Reader(Reader&&) noexcept = default;
Reader& Reader::operator=(Reader&&) noexcept = default;

std::expected<Event, Problem> Reader::next() { return parser_->next(); }

const Attribute* Element::find(std::string_view attribute) const noexcept {
  for (const Attribute& candidate : attributes)
    if (candidate.name == attribute) return &candidate;
  return nullptr;
}

std::expected<Element, Problem> read_tree(std::string_view document) {
  Reader reader{document};
  Element above;  // the document itself; its only child is the root
  std::vector<Element*> open{&above};
  std::size_t nodes = 0;
  for (;;) {
    auto event = reader.next();
    if (!event) return std::unexpected(event.error());
    switch (event->kind) {
      case Event::Kind::Start: {
        nodes += 1 + event->attributes.size();
        if (nodes > max_tree_nodes)
          return std::unexpected(Problem{Refusal::TooLarge, event->at, "more than 200,000 elements and attributes"});
        // Only the last child of an open element is open, so growing `children` moves no open element.
        auto& siblings = open.back()->children;
        siblings.push_back({std::move(event->name), event->at, std::move(event->attributes), {}, {}, {}});
        open.push_back(&siblings.back());
        break;
      }
      case Event::Kind::Text:
        if (open.back()->text_at.line == 0) open.back()->text_at = event->at;
        open.back()->text += event->text;
        break;
      case Event::Kind::End: open.pop_back(); break;
      case Event::Kind::Finished: return std::move(above.children.front());
    }
  }
}

}  // namespace hirosco::xml
