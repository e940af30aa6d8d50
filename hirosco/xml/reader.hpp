// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <expected>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

/// Sequential reading of XML (paper 4.1, "XML"): well-formedness only, meaning is the business of `descriptor`.
namespace hirosco::xml {

/// A place in a document; line and column count from 1, columns in characters (not octets).
struct Position {
  int line{0};
  int column{0};
  friend bool operator==(const Position&, const Position&) = default;
};

struct Attribute {
  std::string name;
  std::string value;                 ///< references replaced
  Position at;                       ///< of the name
  Position value_at;                 ///< of the first character of the value
};

/// Why a document is refused. The document as a whole is then worth nothing.
enum class Refusal {
  NotWellFormed,                     ///< XML syntax, UTF-8, NUL
  NotAllowed,                        ///< XML that we do not take: document types, entities, other encodings
  TooLarge,                          ///< one of the limits below
};
struct Problem {
  Refusal refusal{Refusal::NotWellFormed};
  Position at;
  std::string reason;
};

/// Limits on what comes from outside; more is refused.
inline constexpr std::size_t max_document_octets = 4 * 1024 * 1024;
inline constexpr std::size_t max_attribute_octets = 64 * 1024;
inline constexpr std::size_t max_attributes = 256;
inline constexpr std::size_t max_depth = 64;
/// Elements and attributes of one tree.
inline constexpr std::size_t max_tree_nodes = 200'000;

struct Event {
  enum class Kind { Start, Text, End, Finished };
  Kind kind{Kind::Finished};
  std::string name;                  ///< of the element, for Start and End
  std::vector<Attribute> attributes; ///< for Start, in document order
  std::string text;                  ///< for Text: never only white space
  Position at;                       ///< of '<', for Text of its first character that is not white space
};

/// Gives one event after the other. Comments and processing instructions are passed over.
/// Realtime: allocates. Thread: one.
class Reader {
 public:
  /// `document` must outlive the reader.
  explicit Reader(std::string_view document);
  ~Reader();
  Reader(Reader&&) noexcept;
  Reader& operator=(Reader&&) noexcept;

  /// The next event; Finished for ever after the end. A problem is final: it comes again on every further call.
  [[nodiscard]] std::expected<Event, Problem> next();

 private:
  class Parser;
  std::unique_ptr<Parser> parser_;
};

/// A whole document in memory.
struct Element {
  std::string name;
  Position at;                       ///< of '<'
  std::vector<Attribute> attributes;
  std::vector<Element> children;
  std::string text;                  ///< all text directly inside, in order
  Position text_at;                  ///< line 0 when there is none
  [[nodiscard]] const Attribute* find(std::string_view attribute) const noexcept;
};

/// Reads a document into a tree.  Realtime: allocates.
[[nodiscard]] std::expected<Element, Problem> read_tree(std::string_view document);

}  // namespace hirosco::xml
