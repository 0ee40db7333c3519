#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "results/files/csv_text.hpp"

// The one rule by which the CSV of others is read, and what this program writes for spreadsheets.

namespace mpm {
namespace {

using Fields = std::vector<std::string>;

std::vector<Fields> rows_in(const std::string& text, const CsvForm& form = {}) {
  CsvReader reader(text, "f", form);
  std::vector<Fields> rows;
  for (Fields row; reader.next(row);)
    rows.push_back(row);
  return rows;
}

TEST_CASE("a quote opens a field only where it begins, and closes it on its line", "[csv]") {
  CHECK(rows_in("a,b\n5\" pipe,6\"\n") == std::vector<Fields>{{"5\" pipe", "6\""}});
  CHECK(rows_in("a,b\n \"x,y\" , \"say \"\"z\"\"\"\n") == std::vector<Fields>{{"x,y", "say \"z\""}});
  CHECK(rows_in("a,b\n\"\",\"\"\"\"\n") == std::vector<Fields>{{"", "\""}});
  CHECK(rows_in("a\tb\n\t\"x\ty\"\n") == std::vector<Fields>{{"", "x\ty"}});
  const std::string open = "f:2: found a quote that is not closed on its line";
  CHECK_THROWS_WITH(rows_in("a,b\n1,\"bad\n2,ok\n3,\"ok\"\n"), Catch::StartsWith(open));
  CHECK_THROWS_WITH(rows_in("a,b\n1,\"line\nend\"\n"), Catch::StartsWith(open));
  CHECK_THROWS_WITH(rows_in("a,b\n1,\""), Catch::StartsWith(open));
  CHECK_THROWS_WITH(rows_in("a,b\n1,\"\"\""), Catch::StartsWith(open));
  CHECK_THROWS_WITH(rows_in("a,b\n1,\"x\"y\n"), Catch::StartsWith("f:2: found 'y' after a quoted field"));
  CHECK_THROWS_WITH(rows_in("a,\"b\n1,2\n"), Catch::StartsWith("f:1: found a quote"));
}

TEST_CASE("line ends of any system count as one, empty lines and comments as none", "[csv]") {
  CsvReader reader("\xEF\xBB\xBF# x\r\na,b\r\r1,2\r\n\n#,4\n", "f");
  Fields row;
  CHECK(reader.comments() == Fields{"# x"});
  CHECK((reader.next(row) && row == Fields{"1", "2"} && reader.line() == 4));
  CHECK((reader.next(row) && row == Fields{"#", "4"} && reader.place() == "f:6"));
  CHECK_FALSE(reader.next(row));
  CHECK(rows_in("a,b\n#,4\n", {.comments_everywhere = true}).empty());
}

TEST_CASE("names and cells of others have bounds", "[csv]") {
  const std::string longest(kLongestCsvName, 'n');
  CHECK(rows_in(longest + ",b\n1,2\n").size() == 1);
  CHECK_THROWS_WITH(rows_in(longest + "n,b\n1,2\n"),
                    Catch::StartsWith("f:1: found a column with a name of 1001 bytes, 'nnn") &&
                        Catch::EndsWith("allowed: at most 1000"));
  // Ten million fields are counted or refused at once: no field looks at those behind it.
  const std::string commas(10'000'000, ',');
  CHECK_THROWS_WITH(rows_in(commas + "\n"), "f:1: found a heading of 10000001 columns; allowed: at most " +
                                                std::to_string(kMostForeignColumns) +
                                                ": leave out the others");
  CHECK_THROWS_WITH(rows_in("a,b\n1,2\n" + commas + "x\n"), Catch::StartsWith("f:3: found 10000001 fields"));
  const std::string most(kMostForeignColumns - 1, ',');
  CHECK(rows_in(most + "\n" + most + "\n").size() == 1);
  CHECK(rows_in("a,b\n1,2\n3,4\n", {.separator = ",", .most_cells = 4}).size() == 2);
  CHECK_THROWS_WITH(rows_in("a,b\n1,2\n3,4\n", {.separator = ",", .most_cells = 3}),
                    Catch::StartsWith("f:3: found more than 3 cells"));
}

TEST_CASE("no text that is written for a spreadsheet is a formula of it", "[csv]") {
  for (const char* begin : {"=", "+", "-", "@", "\t"})
    CHECK(csv_field(begin + std::string("cmd")) == "'" + (begin + std::string("cmd")));
  CHECK(csv_field("=HYPERLINK(\"x\",1)") == "\"'=HYPERLINK(\"\"x\"\",1)\"");
  CHECK(csv_field("a=b") == "a=b");
  CHECK(csv_field("a,\"b\"\nc") == "\"a,\"\"b\"\"\nc\"");
  CHECK(csv_field("").empty());
}

}  // namespace
}  // namespace mpm
