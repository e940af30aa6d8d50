// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/xml/reader.hpp"

#include <gtest/gtest.h>

#include <string>

namespace hirosco::xml {
namespace {

Problem problem_of(const std::string& document) {
  const auto tree = read_tree(document);
  EXPECT_FALSE(tree.has_value()) << document.substr(0, 100);
  return tree ? Problem{} : tree.error();
}

TEST(Reader, GivesElementsAttributesAndTextInOrder) {
  Reader reader{"<?xml version=\"1.0\"?>\n<a x='1'>\n  hi<b/>\n</a>"};
  const auto a = reader.next();
  ASSERT_TRUE(a.has_value());
  EXPECT_EQ(a->kind, Event::Kind::Start);
  EXPECT_EQ(a->name, "a");
  EXPECT_EQ(a->at, (Position{2, 1}));
  ASSERT_EQ(a->attributes.size(), 1U);
  EXPECT_EQ(a->attributes[0].value, "1");
  EXPECT_EQ(a->attributes[0].value_at, (Position{2, 7}));
  const auto text = reader.next();
  ASSERT_TRUE(text.has_value());
  EXPECT_EQ(text->kind, Event::Kind::Text);
  EXPECT_EQ(text->at, (Position{3, 3}));
  EXPECT_EQ(reader.next()->kind, Event::Kind::Start);
  const auto end_b = reader.next();
  EXPECT_EQ(end_b->kind, Event::Kind::End);
  EXPECT_EQ(end_b->name, "b");
  EXPECT_EQ(reader.next()->name, "a");
  EXPECT_EQ(reader.next()->kind, Event::Kind::Finished);
  EXPECT_EQ(reader.next()->kind, Event::Kind::Finished);
}

TEST(Reader, LocatesEachAttributeInItsOwnLineAndColumn) {
  const auto tree = read_tree("<a  one = \"=&gt;'\"\n   two='\"x\"' three=\"\"/>");
  ASSERT_TRUE(tree.has_value());
  EXPECT_EQ(tree->find("one")->value, "=>'");
  EXPECT_EQ(tree->find("one")->at, (Position{1, 5}));
  EXPECT_EQ(tree->find("one")->value_at, (Position{1, 12}));
  EXPECT_EQ(tree->find("two")->value, "\"x\"");
  EXPECT_EQ(tree->find("two")->at, (Position{2, 4}));
  EXPECT_EQ(tree->find("two")->value_at, (Position{2, 9}));
  EXPECT_EQ(tree->find("three")->value_at, (Position{2, 21}));
  EXPECT_EQ(tree->find("four"), nullptr);
}

TEST(Reader, CountsColumnsInCharactersAndPassesOverAByteOrderMark) {
  const auto tree = read_tree("\xEF\xBB\xBF<a x=\"\xC3\xA4\xE2\x82\xAC\" y=\"1\"/>");
  ASSERT_TRUE(tree.has_value());
  EXPECT_EQ(tree->at, (Position{1, 1}));
  EXPECT_EQ(tree->find("y")->at, (Position{1, 11}));
}

TEST(Reader, PassesOverCommentsAndInstructions) {
  const auto tree = read_tree("<?xml-model href='x'?><!-- c --><a>one<!-- <b> -->two</a><!-- end -->");
  ASSERT_TRUE(tree.has_value());
  EXPECT_EQ(tree->text, "onetwo");
}

TEST(Reader, SaysWhereADocumentIsNotWellFormed) {
  const Problem mismatch = problem_of("<a>\n  <b></a>");
  EXPECT_EQ(mismatch.refusal, Refusal::NotWellFormed);
  EXPECT_EQ(mismatch.at.line, 2);
  EXPECT_EQ(mismatch.reason, "mismatched tag: </a> stands where <b>, opened in 2:3, is to be closed");
  EXPECT_EQ(problem_of("<a x='1' x='2'/>").reason, "duplicate attribute");
  EXPECT_EQ(problem_of("<a/><b/>").at, (Position{1, 5}));
  EXPECT_EQ(problem_of("").reason, "no element found");
}

TEST(Reader, ATagThatIsMissingIsNamedWithItsPlace) {
  EXPECT_EQ(problem_of("<a>\n <b>\n  <c/>\n</a>").reason,
            "mismatched tag: </a> stands where <b>, opened in 2:2, is to be closed");
  EXPECT_EQ(problem_of("<a>\n <b>").reason, "no element found: the document ends inside <b>, opened in 2:2");
  EXPECT_EQ(problem_of("<a>\n <b></b").reason, "unclosed token: the document ends inside <b>, opened in 2:2");
  const std::string far(5000, 'x');
  EXPECT_LT(problem_of("<" + far + "></y" + far + ">").reason.size(), 250U) << "however long the names are";
}

TEST(Reader, AProblemIsFinal) {
  Reader reader{"<a><b></a>"};
  while (reader.next().has_value()) {}
  EXPECT_FALSE(reader.next().has_value());
  EXPECT_TRUE(reader.next().error().reason.starts_with("mismatched tag: </a>"));
}

TEST(Reader, RefusesDocumentTypesBeforeAnyEntityGrows) {
  const Problem laughs = problem_of(
      "<?xml version=\"1.0\"?>\n<!DOCTYPE l [<!ENTITY a \"ha\"><!ENTITY b \"&a;&a;&a;&a;\"><!ENTITY c "
      "\"&b;&b;&b;\">]>\n"
      "<l>&c;</l>");
  EXPECT_EQ(laughs.refusal, Refusal::NotAllowed);
  EXPECT_EQ(laughs.at, (Position{2, 1}));
  EXPECT_EQ(problem_of("<!DOCTYPE a SYSTEM \"file:///etc/passwd\"><a/>").refusal, Refusal::NotAllowed);
  EXPECT_EQ(problem_of("<a>&unknown;</a>").reason, "undefined entity");
}

TEST(Reader, RefusesOtherEncodings) {
  for (const char* encoding : {"UTF-16", "UTF-7", "IBM037", "ISO-2022-JP", "ISO-8859", "UTF-8x", "latin"})
    EXPECT_EQ(problem_of(std::string{"<?xml version='1.0' encoding='"} + encoding + "'?><a/>").refusal,
              Refusal::NotAllowed)
        << encoding;
  EXPECT_TRUE(read_tree("<?xml version='1.0' encoding='utf-8'?><a/>").has_value());
}

TEST(Reader, TakesAnEncodingThatIsDeclaredAndOfWhichOnlyAsciiIsUsed) {
  for (const std::string encoding : {"ISO-8859-1", "iso-8859-15", "windows-1252"}) {
    const std::string begin = "<?xml version='1.0' encoding='" + encoding + "'?>";
    const auto taken = read_tree(begin + "<a b='c'>~</a>");
    ASSERT_TRUE(taken.has_value()) << encoding;
    EXPECT_EQ(taken->find("b")->value, "c");
    const Problem other = problem_of(begin + "<a>\xC3\xA9</a>");
    EXPECT_EQ(other.refusal, Refusal::NotAllowed) << "one letter as UTF-8, two by what is declared";
    EXPECT_NE(other.reason.find("only ASCII"), std::string::npos);
    EXPECT_EQ(problem_of(begin + "<a>\xE9</a>").reason, "invalid UTF-8");
  }
}

TEST(Reader, RefusesInvalidUtf8AndNul) {
  EXPECT_EQ(problem_of("<a>\n\xFF</a>").at, (Position{2, 1}));
  EXPECT_EQ(problem_of("<a>\n\x80</a>").at, (Position{2, 1}));  // the tail of a character that never began
  EXPECT_EQ(problem_of("<a x=\"\xC0\xAF\"/>").reason, "invalid UTF-8");      // overlong
  EXPECT_EQ(problem_of("<a x=\"\xED\xA0\x80\"/>").reason, "invalid UTF-8");  // surrogate
  EXPECT_EQ(problem_of("<a x=\"\xF4\x90\x80\x80\"/>").reason, "invalid UTF-8");
  EXPECT_EQ(problem_of(std::string("<a>\0</a>", 8)).reason, "a NUL octet is not allowed");
}

TEST(Reader, AcceptsNestingUpToTheLimitOnly) {
  const auto nested = [](std::size_t depth) {
    std::string document;
    for (std::size_t i = 0; i < depth; ++i) document += "<a>";
    for (std::size_t i = 0; i < depth; ++i) document += "</a>";
    return document;
  };
  EXPECT_TRUE(read_tree(nested(max_depth)).has_value());
  EXPECT_EQ(problem_of(nested(max_depth + 1)).refusal, Refusal::TooLarge);
  EXPECT_EQ(problem_of(nested(100'000)).refusal, Refusal::TooLarge);
}

TEST(Reader, AcceptsAttributesUpToTheLimitOnly) {
  const auto document = [](std::size_t octets) { return "<a x=\"" + std::string(octets, 'x') + "\"/>"; };
  EXPECT_TRUE(read_tree(document(max_attribute_octets)).has_value());
  EXPECT_EQ(problem_of(document(max_attribute_octets + 1)).refusal, Refusal::TooLarge);
  EXPECT_EQ(problem_of(document(16 * 1024 * 1024)).refusal, Refusal::TooLarge);
  std::string many = "<a";
  for (std::size_t i = 0; i <= max_attributes; ++i) many += " x" + std::to_string(i) + "=''";
  EXPECT_EQ(problem_of(many + "/>").reason, "the element has more than 256 attributes");
}

TEST(Reader, BoundsTheTree) {
  std::string document = "<a>";
  for (std::size_t i = 0; i < max_tree_nodes; ++i) document += "<b/>";
  EXPECT_EQ(problem_of(document + "</a>").refusal, Refusal::TooLarge);
}

TEST(Reader, RefusesEveryTruncation) {
  const std::string document = "<?xml version=\"1.0\"?><a x=\"\xC3\xA4\"><b y='2'>text</b><!-- c --></a>";
  ASSERT_TRUE(read_tree(document).has_value());
  for (std::size_t octets = 0; octets < document.size(); ++octets)
    EXPECT_FALSE(read_tree(std::string_view{document}.substr(0, octets)).has_value()) << octets;
}

}  // namespace
}  // namespace hirosco::xml
