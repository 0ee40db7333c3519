#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include <catch2/catch.hpp>

#include "results/document/document.hpp"
#include "results/document/document_html.hpp"
#include "results/document/document_markdown.hpp"
#include "results/document/document_text.hpp"
#include "results/document/words.hpp"
#include "results/plot/plot_text.hpp"

namespace {

using namespace mpm;
using Catch::Contains;

TEST_CASE("document: words have marks on a page and none in a text, and foreign ones stay what they are") {
  const std::string words = strong("I_{MPM}") + " " + code("a_{b}<i>\x01") + " " + mpm::link("here", "there");
  CHECK(words_html(words) ==
        "<strong>I<sub>MPM</sub></strong> <code>a_{b}&lt;i&gt; </code> <a href=\"#here\">there</a>");
  CHECK(words_text(words) == "I_MPM a_{b}<i>  there");
  CHECK(listed({"a", "b"}) == "a, b");
  CHECK(listed({}, "none") == "none");
}

TEST_CASE("document: a number has its interval and what it rests on, in both forms") {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const Number found = number_of(Rate{94, 100, 0.94, {0.9, 0.97}});
  CHECK(number_text(found) == "94.0 [90.0, 97.0] %  100");
  CHECK(number_html(found) == "94.0&nbsp;%<br><small>90.0 to 97.0&nbsp;%</small><br><small>of 100</small>");
  CHECK(number_text(number(Rate{})) == "-");
  CHECK_THAT(number_html(Number{}), Contains("&ndash;"));
  CHECK(number_html(fixed(-0.5)) == "&minus;0.500");
  CHECK(number_html(fixed(-kInfinite)) == "&minus;&infin;");
  CHECK(number_text({0.94, NumberForm::whole_percent}) == "94");
  mpm::Table marked("", {{""}, {""}});
  Cell cell = number(Rate{94, 100, 0.94, {0.9, 0.97}}, NumberForm::whole_percent);
  cell.mark = "*";
  marked.row({"", cell});
  Section section{"a", ""};
  section.add(marked);
  CHECK_THAT(document_html({.sections = {section}}), Contains("94*<br><small>90 to 97</small>"));
  CHECK_THAT(table_text(marked), Contains("94 [90, 97]*"));
  marked.row({"alone", Cell{Number{0.94, NumberForm::whole_percent}}});
  Section both{"a", ""};
  both.add(marked);
  const std::string markdown = document_markdown({.sections = {both}});
  CHECK_THAT(markdown, Contains("| 94 (90 to 97)* |") && Contains("| alone | 94 |"));
  CHECK(number_text(Number{1234567.0}) == "1.23e+06");
}

mpm::Table wide_table(std::size_t columns) {
  mpm::Table table("Wide", {{"name", mpm::Table::Align::left}});
  std::vector<Cell> cells{"first"};
  for (std::size_t i = 0; i < columns; ++i) {
    table.columns.push_back({"column" + std::to_string(i)});
    cells.emplace_back(std::to_string(i));
  }
  table.row(std::move(cells));
  return table;
}

TEST_CASE("document text: a wide table goes on below, with its names, and no line is too long") {
  const std::string text = table_text(wide_table(12), 60);
  std::istringstream lines(text);
  int names = 0;
  for (std::string line; std::getline(lines, line);) {
    CHECK(line.size() <= 60);
    names += line.starts_with("first ") ? 1 : 0;
  }
  CHECK(names == 3);
  CHECK_THAT(text, Contains("column11") && !Contains("continued"));
  CHECK_THAT(table_text(wide_table(3), 60), Contains("name   column0  column1  column2\n"
                                                     "first        0        1        2\n"));
}

TEST_CASE("document: columns, groups, anchors and sections are where they are asked for") {
  mpm::Table table("Of <all>", {{"No."},
                                {"here", mpm::Table::Align::left, Shown::text},
                                {"there", mpm::Table::Align::text, Shown::page}});
  table.group("Group");
  table.row({1, "on a terminal", Cell("on a page").toned(Cell::Tone::bad).with("small")}, "row-1");
  Section section{"a", "Title"}, page{.id = "b", .title = "For a page", .shown = Shown::page};
  section.add(table);
  section.say("Said.", Paragraph::Kind::passed);
  page.leave_out("there is nothing.");
  const Document document{.title = "t", .heading = "H", .sections = {section, page}};
  const std::string text = document_text(document), html = document_html(document);
  CHECK_THAT(text, Contains("Group\n") && Contains("on a terminal") && !Contains("on a page") &&
                       !Contains("Left out"));
  CHECK_THAT(html,
             Contains("<tr id=\"row-1\"><th scope=\"row\" class=\"number\">1</th><td class=\"text\"><span "
                      "class=\"no\">on a page</span><br><small>small</small></td></tr>") &&
                 !Contains("on a terminal") && Contains("Of &lt;all&gt;") &&
                 Contains("<p class=\"check passed\">Said.</p>") && Contains("Left out: there is nothing."));
  CHECK_THAT(contents_html(document.sections), Contains("<span>2</span><a href=\"#b\">For a page</a>"));
}

TEST_CASE("document: facts stand under each other, and a long one is broken") {
  Facts facts;
  facts.add("seed", "7", "of the study");
  facts.add("words", std::string(30, 'a') + " " + std::string(30, 'b'));
  Section section{"a", ""};
  section.add(facts);
  const Document document{.sections = {section}};
  CHECK(document_text(document, 50) == "seed          7; of the study\nwords         " +
                                           std::string(30, 'a') + "\n" + std::string(14, ' ') +
                                           std::string(30, 'b') + "\n");
  CHECK_THAT(document_html(document), Contains("<dt>seed</dt><dd>7<br><small>of the study</small></dd>"));
}

}  // namespace
