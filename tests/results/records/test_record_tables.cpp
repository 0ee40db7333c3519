#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "results/files/utf8.hpp"
#include "results/records/csv_columns.hpp"
#include "results/records/data_sketch.hpp"
#include "results/records/date_words.hpp"
#include "results/records/opc_quality.hpp"
#include "results/records/quality_columns.hpp"
#include "results/records/stamped_rows.hpp"
#include "results/records/time_stamps.hpp"
#include "results/records/written_date.hpp"
#include "results/records/zone_clock.hpp"

// Tables as other tools write them: dates, numbers, qualities, layouts.

namespace mpm {
namespace {

constexpr double kNoon = 1709294400.0;  // date -u -d "2024-03-01 12:00" +%s
constexpr double kDay = 86400.0;

TimeStamps stamps_of(const std::vector<std::string>& cells, const StampRules& rules = {}) {
  const std::vector<std::size_t> lines(cells.size(), 2);
  return parse_time_stamps({"t", cells, lines}, rules);
}

StampedRows rows_of(const std::string& text, const DataOptions& data = {}) {
  return stamped_rows({data, 1.0, "min", {"a", "b"}}, parse_csv(text, "f", {.skip = data.skip}));
}

TEST_CASE("dates are read with names of months, without signs between them, and with letters of zones",
          "[records]") {
  for (const char* noon :
       {"01-Mar-24 12:00:00", "1 Mar 2024 12:00", "1/mar/2024:12:00:00", "01MAR2024:12:00:00",
        "Mar 1, 2024 12:00 PM", "March 1 2024 12:00", "2024-Mar-01 12:00", "Fri 1 March 2024 12:00",
        "01.M\xC3\xA4rz.2024 12:00", "20240301T120000", "20240301T120000Z", "2024-03-01 13:00 CET",
        "2024-03-01 12:00 UTC", "2024-03-01 14:00 UTC+02:00", "20240301120000", "202403011200",
        "20240301120000000"}) {
    INFO(noon);
    CHECK(stamps_of({noon}).times == std::vector<double>{kNoon});
    CHECK(stamps_of({noon}).calendar);
  }
  for (const char* none : {"mar", "1 Mar", "31 Foo 2024", "5", "1.5", "-3", "12:00", "Mar 5", "20240301", "T",
                           "", "2024-03-01T", "2024-03-01 12"}) {
    INFO(none);
    CHECK_FALSE(is_date(none));
  }
  for (const char* noon : {"1. 3. 2024 12:00", "2024. 03. 01. 12:00", "1. 3. 2024. 12:00"}) {
    INFO(noon);
    CHECK(stamps_of({noon, noon}, {.order = DateOrder::day_month_year}).times ==
          std::vector<double>{kNoon, kNoon});
  }
  CHECK_THROWS_WITH(stamps_of({"31-Feb-24"}), Catch::Contains("a day that exists"));
  CHECK_THROWS_WITH(stamps_of({"2024-03-01 12:00 CST"}), Catch::Contains("data.time_zone"));
  CHECK(written_time("2:59:30.5 PM")->seconds == 53970.5);
  CHECK_FALSE(written_time("2024-03-01"));
}

TEST_CASE("dates are read in any language", "[records]") {
  for (const char* noon :
       {"01-mar-24 12:00:00", "1 marzo 2024 12:00", "01-m\xC3\xA4rts-2024 12:00", "1 mars 2024 12:00",
        "01/mars/2024 12:00:00 p. m.", "1 de mar\xC3\xA7o de 2024 12:00", "ven. 1 mars 2024 12:00",
        "01-mar\xE7o-2024 12:00", "1 \xD0\xBC\xD0\xB0\xD1\x80\xD1\x82\xD0\xB0 2024 \xD0\xB3., 12:00",
        "01-\xEC\xE0\xF0-2024 12:00",
        "1. b\xC5\x99"
        "ezna 2024 12:00",
        "1 Mart 2024 Cuma 12:00", "01-3\xE6\x9C\x88-24 12:00",
        "2024\xE5\xB9\xB4"
        "3\xE6\x9C\x88"
        "1\xE6\x97\xA5 12:00",
        "2024. m\xC3\xA1rc. 1. 12:00", "01-\xCE\x9C\xCE\xB1\xCF\x81-24 12:00:00 \xCE\xBC\xCE\xBC"}) {
    INFO(noon);
    CHECK(is_date(noon));
    CHECK(stamps_of({noon}).times == std::vector<double>{kNoon});
  }
  const StampRules day_first{.order = DateOrder::day_month_year};
  CHECK(stamps_of({"01/03/2024 11:59:00 a. m.", "01/03/2024 12:00:00 p. m."}, day_first).times ==
        std::vector<double>{kNoon - 60.0, kNoon});
  CHECK(stamps_of({"2024/3/1 \xE4\xB8\x8B\xE5\x8D\x88 12:00:00"}).times == std::vector<double>{kNoon});
  CHECK(stamps_of({"\xD9\xA0\xD9\xA1/\xD9\xA0\xD9\xA3/\xD9\xA2\xD9\xA0\xD9\xA2\xD9\xA4 12:00 \xD9\x85"},
                  day_first)
            .times == std::vector<double>{kNoon});
  // One language for all: of "mar", "ago" and "gen" Italian has the last one, and Spanish has not.
  CHECK(stamps_of({"01-gen-2024", "01-mar-2024", "01-ago-2024"}).times[1] == kNoon - kDay / 2.0);
  CHECK(is_time_of_day("03:30 p. m."));
  CHECK_FALSE(is_time_of_day("TAG12"));
}

TEST_CASE("a word that is another month in another language is refused, with the key", "[records]") {
  CHECK_THROWS_WITH(stamps_of({"01-lis-2024 12:00", "02-lis-2024 12:00"}),
                    Catch::StartsWith("t: found '01-lis-2024 12:00', which is 01-") &&
                        Catch::Contains("Nov-2024 12:00 in cs") && Catch::Contains("Oct-2024 12:00 in hr") &&
                        Catch::Contains("allowed: data.language = "));
  const auto in = [](const char* language) {
    return stamps_of({"01-lis-2024 12:00"}, {.language = language}).times.front();
  };
  CHECK(in("hr") == stamps_of({"2024-10-01 12:00"}).times.front());
  CHECK(in("pl-PL") == stamps_of({"2024-11-01 12:00"}).times.front());
  CHECK_THROWS_WITH(in("klingon"), Catch::Contains("data.language: found 'klingon'; allowed: a language"));
  CHECK(stamps_of({"01-lis-2024", "01-led-2025"}).times.front() ==  // Czech: no other has both
        stamps_of({"2024-11-01"}).times.front());
  CHECK(stamps_of({"31-out-24"}).times.front() == stamps_of({"2024-10-31"}).times.front());
  // Hours are never dropped: "du." is after noon in Hungarian, and a Sunday elsewhere.
  CHECK(stamps_of({"2024. 03. 01. du. 1:00"}).times.front() == kNoon + 3600.0);
  CHECK_THROWS_WITH(stamps_of({"2024-03-01 12:00 cet"}), Catch::Contains("found '2024-03-01 12:00 cet'"));
  CHECK_THROWS_WITH(stamps_of({"01-xyz-2024 12:00"}), Catch::Contains("with months of any language"));
}

TEST_CASE("the form that the study gives has the words of any language", "[records]") {
  const StampRules rules{.format = "%d%b%Y:%I:%M %p"};
  CHECK(stamps_of({"01MARZO2024:12:00 p.m."}, rules).times == std::vector<double>{kNoon});
  CHECK_THROWS_WITH(stamps_of({"01XYZ2024:12:00 PM"}, rules), Catch::Contains("data.time_format"));
}

TEST_CASE("numbers are dates where they can be nothing else, or where the study says so", "[records]") {
  const auto read = [](const std::string& cell, const std::string& unit) {
    return stamps_of({cell}, {.unit = unit});
  };
  for (const auto& [cell, unit] :
       {std::pair{"1709294400", "s"}, std::pair{"1709294400000", "ms"}, std::pair{"1709294400000000", "us"},
        std::pair{"1709294400000000000", "ns"}}) {
    const TimeStamps found = read(cell, ""), said = read(cell, unit);
    CHECK(found.times == std::vector<double>{kNoon});
    CHECK((found.calendar && found.offsets && found.found == unit && found.unit == "s"));
    CHECK((said.times == found.times && said.found.empty() && said.calendar));
  }
  CHECK(read("45352.5", "spreadsheet").times == std::vector<double>{kNoon});
  CHECK(read("739312.5", "matlab").times == std::vector<double>{kNoon});
  CHECK_FALSE(read("45352.5", "").calendar);  // one stamp has no steps
  const std::vector<std::string> days{"45352.5", "45352.500694444", "45352.501388889"};
  const TimeStamps minutes = stamps_of(days, {.sample_days = 1.0 / 1440, .sample = 1.0});
  CHECK(minutes.times == std::vector<double>{kNoon, kNoon + 60, kNoon + 120});
  CHECK(minutes.found == "spreadsheet");
  CHECK_FALSE(stamps_of({"45352", "45353"}, {.sample_days = 1.0 / 1440, .sample = 1.0}).calendar);
  CHECK(read("2500", "ms").times == std::vector<double>{2.5});  // no dates, but a unit
  CHECK_FALSE(read("2500", "ms").calendar);
  CHECK_FALSE(read("1709294400", "min").calendar);
  CHECK_THROWS_WITH(read("1e300", "spreadsheet"), Catch::Contains("data.time_unit"));
}

TEST_CASE("a form that the study gives is read to its end", "[records]") {
  CHECK(stamps_of({"2024 061 12h00"}, {.format = "%Y %j %Hh%M"}).times == std::vector<double>{kNoon});
  CHECK(stamps_of({"01Mar24 13:00:00.25 +0100"}, {.format = "%d%b%y %H:%M:%S %z"}).times ==
        std::vector<double>{kNoon + 0.25});
  CHECK_THROWS_WITH(stamps_of({"2024-03-01 12:00 x"}, {.format = "%Y-%m-%d %H:%M"}),
                    Catch::Contains("data.time_format"));
}

TEST_CASE("the clock of a zone is undone, also in the hour that it shows twice", "[records]") {
  const ZoneClock berlin("Europe/Berlin", "z");
  const double night = 1729987200.0;  // date -u -d "2024-10-27 00:00" +%s
  CHECK(berlin.utc(night + 1.5 * 3600, "", 0.0) == night - 0.5 * 3600);
  CHECK(berlin.utc(night + 2.5 * 3600, "", 0.0) == night + 0.5 * 3600);
  CHECK(berlin.utc(night + 2.5 * 3600, "", night + 3600) == night + 1.5 * 3600);
  CHECK(berlin.utc(night + 2.5 * 3600, "CET", 0.0) == night + 1.5 * 3600);
  CHECK(berlin.utc(night + 2.5 * 3600, "EST", 0.0) == std::nullopt);
  CHECK(berlin.utc(1711852200.0, "", 0.0) == std::nullopt);  // 2024-03-31 02:30
  CHECK_THROWS_WITH(ZoneClock("Mars/Base", "z"), Catch::StartsWith("z: found 'Mars/Base'"));
  const TimeStamps stamps =
      stamps_of({"2024-10-27 02:59", "2024-10-27 02:00", "2024-10-27 03:00"}, {.zone = "Europe/Berlin"});
  CHECK(stamps.times == std::vector<double>{night + 3540, night + 3600, night + 7200});
  CHECK(stamps.offsets);
}

TEST_CASE("thousands are read where the file proves them", "[records]") {
  const auto value = [](const std::string& text, const char* cell, char decimal = '\0') {
    RecordColumns columns = parse_csv(text, "f");
    find_number_form(columns, decimal);
    return columns.number(cell);
  };
  const std::string proven = "t;a\n1;12,345.5\n2;1,5\n";
  CHECK(value(proven, "12,345.5") == 12345.5);
  CHECK(value(proven, "-1,234") == -1234.0);
  CHECK_FALSE(value(proven, "1,5"));
  CHECK_FALSE(value(proven, "1,2345"));
  CHECK(value("t;a\n1;12.345,5\n", "1.234.567,25") == 1234567.25);
  CHECK(value("t;a\n1;1,5\n", "1,234") == 1.234);  // nothing proves them
  CHECK(value("t;a\n1;1,5\n2;1.5\n3;2.5\n", "1,234") == std::nullopt);
  CHECK(value("t;a\n1;01.03.2024\n2;1.5\n", "1.5") == 1.5);
  CHECK(value("t;a\n1;1\n", "1 234.5") == 1234.5);
  CHECK(value("t;a\n1;1\n",
              "1\xC2\xA0"
              "234") == 1234.0);
  CHECK(value("t;a\n1;1\n", "1'234'567") == 1234567.0);
  CHECK_FALSE(value("t;a\n1;1\n", "1 23"));
}

TEST_CASE("a text in UTF-16 is one in UTF-8", "[records]") {
  const std::string wide{'\xFF', '\xFE', 'a', 0, '\xE4', 0, 0x3D, '\xD8', 0x00, '\xDE', '\n', 0};
  CHECK(is_utf16(wide));
  CHECK(utf8_of_utf16(wide) == "a\xC3\xA4\xF0\x9F\x98\x80\n");
  CHECK(utf8_of_utf16(std::string{0, 'a', 0, 'b'}) == "ab");
  CHECK(utf8_of_utf16(std::string{'a', 0, 0x3D, '\xD8', 'b', 0, 'x'}) ==
        "a\xEF\xBF\xBD"
        "b\xEF\xBF\xBD");
  CHECK_FALSE(is_utf16("ab"));
}

TEST_CASE("units, titles and named separators are no rows", "[records]") {
  const RecordColumns csv = parse_csv("sep=;\nTime;a\n;wt%\ns;1/min\n2024-03-01;1\n", "f");
  CHECK(csv.separator == ';');
  CHECK(csv.rows() == 1);
  CHECK(csv.units == std::vector<std::string>{"", "wt%"});
  CHECK(csv.warnings.size() == 1);
  CHECK(parse_csv("Report\n\nt,a\n1,2\n", "f", {.skip = {1}}).names == std::vector<std::string>{"t", "a"});
  CHECK_THROWS_WITH(parse_csv("Report\nt,a\n1,2\n", "f"), Catch::Contains("data.skip"));
  CHECK(parse_csv("t,a\n1,2,,\n", "f").rows() == 1);
  CHECK_THROWS_WITH(parse_csv("t,a\n1,2,,3\n", "f"), Catch::Contains("found 4 fields"));
}

TEST_CASE("rows are made of values with stamps of their own, and of rows of one value", "[records]") {
  const StampedRows per_tag = rows_of("time,a,time,b\n1,10,2,20\n2,11,3,21\n,,4,22\n");
  CHECK(per_tag.times == std::vector<double>{1, 2, 3, 4});
  CHECK(per_tag.file.names == std::vector<std::string>{"a", "b"});
  CHECK(per_tag.file.columns ==
        std::vector<std::vector<std::string>>{{"10", "11", "", ""}, {"", "20", "21", "22"}});
  const StampedRows rows = rows_of("time,tag,value,q\n3,a,1,x\n1,b,2,y\n1,b,3,z\n3,b,4,\n");
  CHECK(rows.times == std::vector<double>{1, 1, 3});
  CHECK(rows.file.names == std::vector<std::string>{"a", "a.q", "b", "b.q"});
  CHECK(rows.file.columns ==
        std::vector<std::vector<std::string>>{{"", "", "1"}, {"", "", "x"}, {"2", "3", "4"}, {"y", "z", ""}});
  CHECK(rows.file.lines == std::vector<std::size_t>{3, 4, 2});
  CHECK_THROWS_WITH(rows_of("time,tag,value\n2,b,1\n1,b,2\n3,b,2\n"),
                    Catch::Contains("f: column 'time', line 3"));
  CHECK_THROWS_WITH(rows_of("time,a,time,b\n1,1,2024-03-01,1\n"), Catch::Contains("another kind"));
  DataOptions wide;
  wide.layout = TableLayout::wide;
  CHECK_THROWS_WITH(rows_of("time,a,time,b\n1,1,1,1\n", wide), Catch::Contains("two columns of this name"));
}

TEST_CASE("a date and a time of day may have a column each", "[records]") {
  const std::string text = "Day,Clock,a\n2024-03-01 00:00,12:00 PM,1\n2024-03-01 00:00,12:01 PM,2\n";
  CHECK(rows_of(text).times == std::vector<double>{kNoon, kNoon + 60});
  CHECK_THROWS_WITH(rows_of("time,a\n12:00,1\n"), Catch::Contains("data.date"));
  CHECK(rows_of("a,b\n1,2\n2,3\n").stamped == false);
  CHECK(rows_of("t,a\n1,2\n").stamped);
}

TEST_CASE("the codes of OPC are known", "[records]") {
  const auto good = [](const std::vector<std::string>& cells) {
    RecordColumns file;
    file.columns = {cells};
    const OpcCodes codes = opc_codes(file, 0);
    std::vector<bool> found;
    for (const std::string& cell : cells)
      found.push_back(is_good_opc(file, cell, codes));
    return found;
  };
  CHECK(good({"192", "216.0", "195", "65472", "24", "0", "64", "Good_Clamped", "Bad", "192.5", ""}) ==
        std::vector<bool>{true, true, true, true, false, false, false, true, false, false, false});
  CHECK(good({"0", "0x00960000", "1073741824", "-2147483648", "2147483648", "192"}) ==
        std::vector<bool>{true, true, false, false, false, true});
  CHECK(good({"1e300", "-1e300"}) == std::vector<bool>{false, false});
}

TEST_CASE("the column of a quality is found by its heading and by what it holds", "[records]") {
  const auto quality_of = [](const std::string& value, const std::vector<std::string>& headings) {
    RecordColumns file;
    file.names = {value};
    file.names.insert(file.names.end(), headings.begin(), headings.end());
    file.columns.assign(file.names.size(), {"Good", "Bad"});
    const auto found = quality_column_of(file, 0);
    return found ? file.names[*found] : "";
  };
  for (const char* heading :
       {"xD.Status", "XD_QUALITY", "xD q", "Status xD", "quality_xD", "xD_Validity", "xD.ok"})
    CHECK(quality_of("xD", {"xB.Status", heading}) == heading);
  CHECK(quality_of("xD.PV", {"xD.Status"}) == "xD.Status");
  CHECK(quality_of("xD.PV", {"xD.PV.Status"}) == "xD.PV.Status");
  CHECK(quality_of("xD", {"Quality", "xB.Status"}) == "Quality");
  CHECK(quality_of("xD", {"xD.Quality", "Quality"}) == "xD.Quality");
  CHECK(quality_of("xD", {"xB.Status", "xD.SP"}).empty());
  CHECK(quality_of("xD", {"xD.Status", "xD.Quality"}).empty());  // which one?

  const auto are = [](const std::vector<std::string>& cells) {
    RecordColumns file;
    file.columns = {cells};
    return are_qualities(file, 0);
  };
  CHECK((are({"Good", "Bad", ""}) && are({"good (local)", "I/O Timeout"}) && are({"192", "0", "28"}) &&
         are({"0", "0x80320000"})));
  CHECK_FALSE((are({"Bad", "Bad"}) || are({"0", "1"}) || are({"192", "193.5"}) || are({"192", "200"}) ||
               are({"Good", "7"}) || are({""}) || are({"AUTO", "MAN"})));

  const StampedRows repeated = rows_of("t,a,Status,b,Status\n1,2,Good,3,Bad\n2,2,Good,3,Good\n");
  CHECK(repeated.file.names == std::vector<std::string>{"t", "a", "a.Status", "b", "b.Status"});
}

TEST_CASE("a file gives first guesses of [data], which are called so", "[records]") {
  PlantModel plant;
  plant.time_unit = "min";
  plant.cvs = {{"level", "1", ""}};
  plant.mvs = {{"flow", "1", ""}};
  plant.mds = {{"feed", "1", ""}};
  std::string text = "Time,LI1_level.PV,LI1_level.SP,FI flow,AI feed,other\n";
  for (int k = 0; k < 50; ++k)
    text += "2024-03-01 12:" + std::to_string(10 + k) + "," + std::to_string(80 + k % 2) + ",80," +
            std::to_string(k < 10 ? k : 9) + "," + std::to_string(k / 3) + "," + std::to_string(k) + "\n";
  const DataSketch sketch = data_sketch(plant, parse_csv(text, "f"));
  CHECK(sketch.step == Approx(1.0));
  CHECK(sketch.noise.at("level") == Approx(1.4826 * 2.0 / std::sqrt(6.0)));
  for (const char* part :
       {"tags = {level = \"LI1_level.PV\", flow = \"FI flow\", feed = \"AI feed\"}", "# Guess",
        "operating_point = {level = 80.5, flow = 8.1, feed = 7.84}", "setpoint = {level = \"LI1_level.SP\"}",
        "period = [\"2024-03-01 12:10:00\", \"2024-03-01 12:59:00\"]", "#   other: 0 to 49"})
    CHECK_THAT(sketch.table, Catch::Contains(part));
  CHECK(sketch.periods == std::map<std::string, std::size_t>{{"feed", 3}});
  CHECK_THAT(sketch.rests.at("flow"), Catch::Contains("upper tenth") && Catch::Contains("negative"));
}

TEST_CASE("guesses know setpoint, mode and quality beside a tag, and leave bad values out", "[records]") {
  PlantModel plant;
  plant.time_unit = "min";
  plant.cvs = {{"AI101", "1", ""}};
  plant.mvs = {{"FC11", "1", ""}, {"reflux", "1", ""}};
  std::string text = "time,AI101.PV,AI101.SP,AI101.Status,FC11.PV,FC11.SP,FC11.MODE,FC11.Q\n";
  for (int k = 0; k < 50; ++k)
    text += std::to_string(k) + "," + (k == 7 ? "1000,96,Bad" : std::to_string(96 + k % 2) + ",96,Good") +
            ",7.5,7,CAS,Good\n";
  const DataSketch sketch = data_sketch(plant, parse_csv(text, "f"));
  for (const char* part :
       {"tags = {AI101 = \"AI101.PV\", FC11 = \"FC11.SP\"}", "setpoint = {AI101 = \"AI101.SP\"}",
        "mode = {FC11 = \"FC11.MODE\"}", "quality = {AI101 = \"AI101.Status\", FC11 = \"FC11.Q\"}",
        "no column has a name like reflux", "operating_point = {AI101 = 96.4898, FC11 = 7}"})
    CHECK_THAT(sketch.table, Catch::Contains(part));
  CHECK(sketch.spread.at("AI101") < 1.0);
  CHECK(data_sketch(plant, parse_csv("time,FC11.SP\n1,2\n2,3\n", "f")).table.find("\"FC11.SP\"") !=
        std::string::npos);
}

}  // namespace
}  // namespace mpm
