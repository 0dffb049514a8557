#include "core/text_template.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace simwright::core {
namespace {

TEST(TextTemplate, FillsEveryPlaceholder) {
  EXPECT_EQ(FillTemplate("<h1>{{title}}</h1>{{title}}, {{count}}",
                         {{"title", "cups"}, {"count", std::string("3")}}),
            "<h1>cups</h1>cups, 3");
  EXPECT_EQ(FillTemplate("none", {}), "none");
  EXPECT_EQ(FillTemplate("", {}), "");
  EXPECT_EQ(FillTemplate("a{b}{{c}}d}}", {{"c", ""}}), "a{b}d}}");
}

TEST(TextTemplate, EscapesTextsButNotMarkup) {
  EXPECT_EQ(FillTemplate("<p title=\"{{a}}\">{{b}}</p>", {{"a", "\"<&>'"}, {"b", Markup{"<b/>"}}}),
            "<p title=\"&quot;&lt;&amp;&gt;&#39;\"><b/></p>");
  EXPECT_EQ(EscapedMarkup("a\tb\nc\x01"), "a\tb\nc");
}

TEST(TextTemplate, DoesNotSearchValuesForPlaceholders) {
  EXPECT_EQ(FillTemplate("{{a}}{{b}}", {{"a", Markup{"{{b}}"}}, {"b", "{{a}}"}}), "{{b}}{{a}}");
}

TEST(TextTemplate, RefusesUnfilledAndUnknownPlaceholders) {
  EXPECT_THROW(FillTemplate("{{a}}", {}), Error);
  EXPECT_THROW(FillTemplate("{{a}} {{b}}", {{"a", "1"}}), Error);
  EXPECT_THROW(FillTemplate("{{a}}", {{"a", "1"}, {"b", "2"}}), Error);
  EXPECT_THROW(FillTemplate("{{ a }}", {{"a", "1"}}), Error);
  EXPECT_THROW(FillTemplate("{{a} and more", {{"a", "1"}}), Error);
}

}  // namespace
}  // namespace simwright::core
