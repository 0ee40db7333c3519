#include <filesystem>
#include <fstream>
#include <string>

#include <catch2/catch.hpp>
#include <unistd.h>

#include "analysis/study_files/table_file.hpp"
#include "analysis/study_files/thesis_table.hpp"
#include "base/error.hpp"
#include "tests/scenarios/study_texts.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;
using testing::line_of;
using testing::replaced;

const std::vector<TableQuantity> kQuantities{{"ivar"},
                                             {"ivar_diag"},
                                             {"sse"},
                                             {"method.index", QuantityScope::loop},
                                             {"method.correlation", QuantityScope::channel}};

/// Two studies, two columns (one of them with its own CV), three rules, three rows.
const std::string kTable = R"([table]
chapter = 4
number = 5
title = "A table"
study = "chapter4-shell"

[[variant]]
name = "slow"
set.controller.mv.u1.move_suppression = 10

[[column]]
head = "first"
cv = "y1"

[[column]]
head = "second"

[[rule]]
quantities = ["ivar"]
band = [0.8, 1.2]
yes = "flagged"
no = "not flagged"
source = "somewhere"

[[row]]
label = "Ivar"
scenario = "Scen1"
cv = "y3"
quantity = "ivar"
values = [4.54, 1]

[[row]]
label = "slow"
variant = "slow"
cv = "y2"
quantity = "sse"
values = [1.5, ""]
)";

/// A folder of tables that is gone afterwards.
class TableFolder {
 public:
  TableFolder() : folder_(fs::temp_directory_path() / ("mpmbench-tables-" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~TableFolder() { fs::remove_all(folder_); }
  TableFolder(const TableFolder&) = delete;
  TableFolder& operator=(const TableFolder&) = delete;

  fs::path put(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  const fs::path& path() const { return folder_; }

 private:
  fs::path folder_;
};

/// The message without the folder; "accepted" without one.
template <class Read>
std::string message_of(const fs::path& folder, Read read) {
  try {
    read();
  } catch (const InputError& error) {
    std::string text = error.what();
    if (text.rfind(folder.string() + "/", 0) == 0)
      text.erase(0, folder.string().size() + 1);
    return text;
  }
  return "accepted";
}

/// How the table is refused with the first `from` replaced by `to`.
std::string table_refusal(const std::string& from, const std::string& to) {
  const TableFolder folder;
  const fs::path file = folder.put("t.toml", replaced(kTable, from, to));
  return message_of(folder.path(), [&] { load_table(file, kQuantities); });
}

std::string number(int chapter, int table) {
  return replaced(replaced(kTable, "chapter = 4", "chapter = " + std::to_string(chapter)), "number = 5",
                  "number = " + std::to_string(table));
}

}  // namespace

TEST_CASE("a cell has what its row and its column say", "[table_file]") {
  const TableFolder folder;
  const ThesisTable table = load_table(folder.put("t.toml", kTable), kQuantities);
  CHECK(table.number == "4.5");
  CHECK(table.chapter == 4);
  CHECK(table.title == "A table");
  CHECK(table.note.empty());
  CHECK(table.heads == std::vector<std::string>{"first", "second"});
  REQUIRE(table.studies.size() == 2);
  CHECK(table.studies.at("").controller.move_suppression(0) !=
        table.studies.at("slow").controller.move_suppression(0));
  REQUIRE(table.rows.size() == 2);
  CHECK(table.rows[0].scenario == "Scen1");
  CHECK(table.rows[0].variant.empty());
  CHECK(table.rows[0].cells[0].cv == "y1");  // of the column, although the row has one
  CHECK(table.rows[0].cells[1].cv == "y3");
  CHECK(table.rows[0].cells[1].quantity == "ivar");
  CHECK(table.rows[0].cells[0].thesis == 4.54);
  CHECK(table.rows[0].cells[1].thesis == 1.0);
  CHECK(table.rows[1].variant == "slow");
  CHECK(table.rows[1].scenario.empty());
  CHECK_FALSE(table.rows[1].cells[1].thesis);
  REQUIRE(table.rule_for("ivar") != nullptr);
  CHECK(table.rule_for("ivar")->lower == 0.8);
  CHECK(table.rule_for("sse") == nullptr);
}

TEST_CASE("a * in the quantity of a row stands for that of the column", "[table_file]") {
  const TableFolder folder;
  std::string text = replaced(kTable, "cv = \"y1\"\n", "cv = \"y1\"\nquantity = \"_diag\"\n");
  text = replaced(text, "head = \"second\"\n", "head = \"second\"\nquantity = \"ivar\"\n");
  text =
      replaced(text, "quantity = \"ivar\"\nvalues = [4.54, 1]", "quantity = \"ivar*\"\nvalues = [4.54, 1]");
  const auto message =
      message_of(folder.path(), [&] { load_table(folder.put("t.toml", text), kQuantities); });
  CHECK_THAT(message, Catch::Contains("row[0].quantity: found quantity 'ivarivar'"));
}

TEST_CASE("a table may have verdicts in words in place of numbers", "[table_file]") {
  const auto with = [](const std::string& verdicts) {
    return replaced(kTable, "values = [4.54, 1]", verdicts);
  };
  const TableFolder folder;
  const ThesisTable table =
      load_table(folder.put("t.toml", with("verdicts = [\"flagged\", \"\"]")), kQuantities);
  CHECK(table.rows[0].cells[0].verdict == "flagged");
  CHECK_FALSE(table.rows[0].cells[0].thesis);
  CHECK_FALSE(table.rows[0].cells[1].verdict);

  const auto refused = [](const std::string& verdicts) {
    return table_refusal("values = [4.54, 1]", verdicts);
  };
  CHECK_THAT(refused("verdicts = [\"flaged\", \"\"]"),
             Catch::Contains("row[0].verdicts: found 'flaged'; allowed: flagged or not flagged"));
  CHECK_THAT(refused("verdicts = [\"flagged\"]"), Catch::Contains("a list of 2 texts"));
  CHECK_THAT(refused("verdicts = [\"flagged\", 1]"), Catch::Contains("\"\" for an empty cell"));
  CHECK_THAT(refused("verdicts = [\"\", \"\"]\nvalues = [1, 2]"),
             Catch::Contains("row[0]: found both values and verdicts"));
  CHECK_THAT(refused(""), Catch::Contains("row[0]: found neither values nor verdicts"));
  CHECK_THAT(table_refusal("values = [1.5, \"\"]", "verdicts = [\"flagged\", \"\"]"),
             Catch::Contains("no verdict on a quantity without a rule"));
}

TEST_CASE("a quantity of the loop has no CV, one of a channel has a CV and an MV", "[table_file]") {
  const TableFolder folder;
  const auto rows_with = [&](const std::string& quantity_and_mv) {
    const std::string text = replaced(kTable, "quantity = \"ivar\"\nvalues", quantity_and_mv + "\nvalues");
    return load_table(folder.put("t.toml", text), kQuantities).rows.at(0).cells;
  };
  const std::vector<TableCell> of_loop = rows_with("quantity = \"method.index\"");
  CHECK(of_loop[0].cv.empty());  // although the column has one
  CHECK(of_loop[1].cv.empty());
  CHECK(of_loop[1].mv.empty());
  const std::vector<TableCell> of_channel = rows_with("quantity = \"method.correlation\"\nmv = \"u2\"");
  CHECK(of_channel[0].cv == "y1");
  CHECK(of_channel[1].cv == "y3");
  CHECK(of_channel[0].mv == "u2");
  CHECK(of_channel[1].mv == "u2");
  const std::vector<TableCell> of_cv = rows_with("quantity = \"ivar\"\nmv = \"u2\"");
  CHECK(of_cv[0].mv.empty());  // a quantity of a CV takes no notice of it

  std::string columns = replaced(kTable, "quantity = \"ivar\"\nvalues",
                                 "quantity = \"method.correlation\"\nmv = \"u2\"\nvalues");
  columns = replaced(columns, "cv = \"y1\"\n", "cv = \"y1\"\nmv = \"u3\"\n");
  const std::vector<TableCell> cells = load_table(folder.put("t.toml", columns), kQuantities).rows[0].cells;
  CHECK(cells[0].mv == "u3");  // of the column, although the row has one
  CHECK(cells[1].mv == "u2");

  const std::string channel = "quantity = \"method.correlation\"";
  CHECK_THAT(table_refusal("quantity = \"ivar\"", channel),
             Catch::Contains("row[0]: found no mv for column 'first'"));
  CHECK_THAT(table_refusal("quantity = \"ivar\"", channel + "\nmv = \"u9\""),
             Catch::Contains("row[0].mv: found mv 'u9'") && Catch::Contains("allowed: u1, u2, u3"));
  CHECK_THAT(table_refusal("cv = \"y1\"", "cv = \"y1\"\nmv = \"u9\""),
             Catch::Contains("column[0].mv: found 'u9'"));
}

TEST_CASE("a figure in words is a table with a name of its own", "[table_file]") {
  const TableFolder folder;
  const auto figure = [](int number) {
    return replaced(kTable, "number = 5", "figure = " + std::to_string(number));
  };
  const ThesisTable table = load_table(folder.put("f.toml", figure(8)), kQuantities);
  CHECK(table.figure);
  CHECK(table.label() == "Figure 4.8");
  CHECK(table.name() == "figure4.8");

  folder.put("a.toml", number(4, 8));  // figures and tables have numbers of their own
  folder.put("b.toml", number(4, 10));
  folder.put("c.toml", number(5, 1));
  const auto names = [&](const std::string& which) {
    std::string text;
    for (const ThesisTable& found : find_tables(which, kQuantities, folder.path()))
      text += found.name() + " ";
    return text;
  };
  CHECK(names("all") == "4.8 4.10 figure4.8 5.1 ");
  CHECK(names("chapter4") == "4.8 4.10 figure4.8 ");
  CHECK(names("figure4.8") == "figure4.8 ");
  CHECK(names("4.8") == "4.8 ");
  folder.put("g.toml", figure(8));
  CHECK_THAT(message_of(folder.path(), [&] { names("all"); }), Catch::Contains("two files for Figure 4.8"));
}

TEST_CASE("a table is either a table or a figure", "[table_file]") {
  CHECK_THAT(table_refusal("number = 5", "number = 5\nfigure = 8"),
             Catch::Contains("table: found both number and figure; allowed: exactly one of the two"));
  CHECK_THAT(table_refusal("number = 5\n", ""), Catch::Contains("table: found neither number nor figure"));
  CHECK_THAT(table_refusal("number = 5", "figure = 0"), Catch::Contains("table.figure: found 0"));
}

TEST_CASE("a row can name the benchmark of methods that need one", "[table_file]") {
  const TableFolder folder;
  const auto benchmark = [&](const std::string& key) {
    const std::string text = replaced(kTable, "scenario = \"Scen1\"\n", "scenario = \"Scen1\"\n" + key);
    return load_table(folder.put("t.toml", text), kQuantities).rows.at(0).benchmark;
  };
  CHECK_FALSE(benchmark("").has_value());  // the basis case of the variant of the row
  CHECK(benchmark("benchmark = \"slow\"\n") == "slow");
  CHECK(benchmark("benchmark = \"study\"\n") == "");  // the study as it is
  CHECK_THAT(table_refusal("scenario = \"Scen1\"", "scenario = \"Scen1\"\nbenchmark = \"slo\""),
             Catch::Contains("row[0].benchmark: found 'slo' (nearest: 'slow')"));
  CHECK_THAT(table_refusal("name = \"slow\"", "name = \"study\""),
             Catch::Contains("variant[0].name: found 'study'; allowed: another name"));
}

TEST_CASE("a variant can be another study", "[table_file]") {
  const TableFolder folder;
  const auto with_other = [&](const std::string& keys) {
    return folder.put("t.toml",
                      replaced(kTable, "[[row]]", "[[variant]]\nname = \"other\"\n" + keys + "\n[[row]]"));
  };
  const ThesisTable table = load_table(with_other("study = \"wood-berry\""), kQuantities);
  CHECK(table.studies.at("other").name == "wood-berry");
  CHECK(table.studies.at("").name != "wood-berry");
  const ThesisTable changed =
      load_table(with_other("study = \"wood-berry\"\nset.simulation.samples = 321"), kQuantities);
  CHECK(changed.studies.at("other").simulation.samples == 321);
  CHECK_THAT(message_of(folder.path(), [&] { load_table(with_other("study = \"wood-bery\""), kQuantities); }),
             Catch::Contains("variant[1].study") && Catch::Contains("nearest: 'wood-berry'"));
}

TEST_CASE("what a table file cannot mean is refused by file, line and key", "[table_file]") {
  CHECK_THAT(table_refusal("cv = \"y1\"", "cv = \"y9\""),
             Catch::StartsWith("t.toml:13: column[0].cv: found 'y9'"));
  CHECK_THAT(table_refusal("cv = \"y3\"", "cv = \"y9\""), Catch::Contains("row[0].cv: found cv 'y9'"));
  CHECK_THAT(table_refusal("cv = \"y3\"\n", ""), Catch::Contains("row[0]: found no cv for column 'second'"));
  CHECK_THAT(table_refusal("quantity = \"ivar\"\n", ""),
             Catch::Contains("found no quantity for column 'first'"));
  CHECK_THAT(table_refusal("quantity = \"ivar\"", "quantity = \"ivarr\""),
             Catch::Contains("row[0].quantity: found quantity 'ivarr' (nearest: 'ivar')") &&
                 Catch::Contains("allowed: ivar, ivar_diag, sse"));
  CHECK_THAT(table_refusal("\"Scen1\"", "\"Scen99\""), Catch::Contains("row[0].scenario: found 'Scen99'"));
  CHECK_THAT(table_refusal("variant = \"slow\"", "variant = \"slo\""),
             Catch::Contains("row[1].variant: found 'slo' (nearest: 'slow'); allowed: slow"));
  CHECK_THAT(table_refusal("[4.54, 1]", "[4.54]"), Catch::Contains("row[0].values"));
  CHECK_THAT(table_refusal("[4.54, 1]", "[4.54, nan]"), Catch::Contains("row[0].values: found nan"));
  CHECK_THAT(table_refusal("[4.54, 1]", "[4.54, \"-\"]"), Catch::Contains("\"\" for an empty cell"));
  CHECK_THAT(table_refusal("[4.54, 1]", "[4.54, true]"), Catch::Contains("row[0].values: found true"));
  CHECK_THAT(table_refusal("[0.8, 1.2]", "[1.2, 0.8]"), Catch::Contains("rule[0].band"));
  CHECK_THAT(table_refusal("band = [0.8, 1.2]\n", ""), Catch::Contains("rule[0].band: found nothing"));
  CHECK_THAT(table_refusal("[\"ivar\"]", "[\"ivr\"]"), Catch::Contains("rule[0].quantities"));
  CHECK_THAT(table_refusal("band = [0.8, 1.2]", "kind = \"any-above\"\nband = [0.8, 1.2]"),
             Catch::Contains("rule[0].band: found a key that this kind of rule does not use"));
  CHECK_THAT(table_refusal("band = [0.8, 1.2]", "kind = \"rank\""),
             Catch::Contains("rule[0].yes: found a key that this kind of rule does not use"));
  CHECK_THAT(table_refusal("band = [0.8, 1.2]", "kind = \"above\""),
             Catch::Contains("rule[0].kind: found 'above'"));
  CHECK_THAT(table_refusal("[[row]]",
                           "[[rule]]\nquantities = [\"ivar\"]\nkind = \"rank\"\nsource = \"s\"\n\n[[row]]"),
             Catch::Contains("rule[1].quantities: found 'ivar', which has a rule already"));
  CHECK_THAT(table_refusal("[[column]]", "[[variant]]\nname = \"slow\"\nset.study.seed = 1\n\n[[column]]"),
             Catch::Contains("variant[1].name: found 'slow'; allowed: each name once"));
  CHECK_THAT(table_refusal("set.controller.mv.u1", "set.controller.mv.u9"), Catch::Contains("(slow)"));
  CHECK_THAT(table_refusal("\"chapter4-shell\"", "\"chapter6\""), Catch::Contains("names no scenarios"));
  CHECK_THAT(table_refusal("\"chapter4-shell\"", "\"nowhere\""), Catch::Contains("table.study"));
  CHECK_THAT(table_refusal("chapter = 4", "chapter = 8"), Catch::Contains("table.chapter: found 8"));
  CHECK_THAT(table_refusal("title", "titel"), Catch::Contains("nearest: 'title'"));
}

TEST_CASE("tables are found by chapter and number, in the order of the numbers", "[table_file]") {
  const TableFolder folder;
  folder.put("a.toml", number(4, 10));
  folder.put("b.toml", number(4, 5));
  folder.put("c.toml", number(3, 1));
  folder.put("notes.txt", "no table");
  const auto numbers = [&](const std::string& which) {
    std::string text;
    for (const ThesisTable& table : find_tables(which, kQuantities, folder.path()))
      text += table.number + " ";
    return text;
  };
  CHECK(numbers("all") == "3.1 4.5 4.10 ");
  CHECK(numbers("chapter4") == "4.5 4.10 ");
  CHECK(numbers("4.10") == "4.10 ");
  CHECK_THAT(message_of(folder.path(), [&] { numbers("4.1"); }),
             Catch::Contains("tables: found '4.1'") &&
                 Catch::Contains("allowed: all, chapter3, chapter4, 3.1, 4.5, 4.10"));
  folder.put("d.toml", number(4, 5));
  CHECK_THAT(message_of(folder.path(), [&] { numbers("all"); }), Catch::Contains("two files for Table 4.5"));
  CHECK_THROWS_WITH(find_tables("all", kQuantities, folder.path() / "none"),
                    Catch::Contains("folder of the tables"));
}

}  // namespace mpm
