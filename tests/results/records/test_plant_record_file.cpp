#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "analysis/study_files/study_file.hpp"
#include "base/error.hpp"
#include "results/records/csv_columns.hpp"
#include "results/records/date_words.hpp"
#include "results/records/plant_record_file.hpp"
#include "results/records/time_stamps.hpp"
#include "results/records/written_date.hpp"
#include "tests/scenarios/study_texts.hpp"

// Files of records: their text, their time stamps, and the samples that come of them.

namespace mpm {
namespace {

using namespace testing;

Study study_with(const std::string& data) {
  return parse_study(small_study() + "[data]\n" + data, "s.toml");
}

std::vector<double> times_of(const std::vector<std::string>& cells, DateOrder order = DateOrder::automatic) {
  const std::vector<std::size_t> lines(cells.size(), 2);
  return parse_time_stamps({"t", cells, lines}, {.order = order}).times;
}

/// A record of the small study in which each variable has a value of its own.
std::string record_text(const std::vector<std::string>& rows) {
  std::string text = "time,level,heat,hot,cold,drain\n";
  for (const std::string& row : rows)
    text += row + "\n";
  return text;
}

TEST_CASE("a CSV text is read as RFC 4180 and spreadsheets have it", "[records]") {
  const RecordColumns csv = parse_csv(
      "\xEF\xBB\xBF# made by a historian\r\n\"a;1\" ; b\r\n\r\n1,5;\"say \"\"x\"\"\"\r\n2;\r\n", "f");
  CHECK(csv.separator == ';');
  CHECK(csv.names == std::vector<std::string>{"a;1", "b"});
  CHECK(csv.columns == std::vector<std::vector<std::string>>{{"1,5", "2"}, {"say \"x\"", ""}});
  CHECK(csv.lines == std::vector<std::size_t>{4, 5});
  CHECK(parse_csv("a|b\n1|2\n", "f").separator == '|');
  CHECK_THROWS_WITH(parse_csv("a,b\n1,2\n3\n", "f"),
                    "f:3: found 1 fields; allowed: 2, as the heading has them");
  CHECK_THROWS_WITH(parse_csv("1,2\n3,4\n", "f"), Catch::Contains("f:1: found numbers"));
}

TEST_CASE("time stamps are those of the calendar", "[records]") {
  const double noon = 1709294400.0;  // date -u -d "2024-03-01 12:00" +%s
  CHECK(times_of({"2024-03-01 12:00", "2024-03-01 12:00:00.25"}) == std::vector<double>{noon, noon + 0.25});
  CHECK(times_of({"2024-03-01T12:00:00Z", "2024-03-01T13:00:00+01:00"}) == std::vector<double>{noon, noon});
  CHECK(times_of({"01.03.2024 12:00"}) == std::vector<double>{noon});
  CHECK(times_of({"3/1/2024 12:00 PM", "3/13/2024 12:00 am"}) ==
        std::vector<double>{noon, noon + 11.5 * 86400.0});
  CHECK(times_of({"1/3/2024 12:00"}, DateOrder::day_month_year) == std::vector<double>{noon});
  CHECK(std::isnan(times_of({"1", "", "3"})[1]));
  CHECK(date_text(noon + 59.9) == "2024-03-01 12:00:59");
  CHECK_THROWS_WITH(times_of({"2024-02-30"}), Catch::Contains("a day that exists"));
  CHECK_THROWS_WITH(times_of({"2024-02-28", "5"}), Catch::Contains("stamps of one form"));
  CHECK(times_of({"2024-02-29 24:00", "2024-03-01 00:00:00"}) == std::vector<double>(2, noon - 43200.0));
}

TEST_CASE("a time that no clock shows is refused, and so are two ways to write it", "[records]") {
  for (const char* wrong : {"1/13/2024 99:00 PM", "1/13/2024 13:00 PM", "1/13/2024 0:30 AM",
                            "2024-01-13 24:59", "2024-01-13 24:00:01", "2024-01-13 25:00",
                            "2024-01-13 12:00+99:99", "2024-01-13 12:00+14:30", "2024-01-13 12:00-01:60"}) {
    INFO(wrong);
    CHECK_THROWS_WITH(times_of({wrong}), Catch::Contains("t, line 2: found '" + std::string(wrong)));
    CHECK_FALSE(is_date(wrong));
  }
  CHECK_THROWS_WITH(times_of({"2024-01-13 12:00Z", "2024-01-13 12:01"}),
                    Catch::Contains("found '2024-01-13 12:01'") && Catch::Contains("all have their offset"));
  CHECK_THROWS_WITH(times_of({"1/13/2024 11:59 AM", "1/13/2024 12:00"}),
                    Catch::Contains("all have AM or PM"));
  CHECK(times_of({"13.01.2024", "13.01.2024 00:01"}).size() == 2);  // as spreadsheets drop midnight
}

TEST_CASE("rows become samples of the controller", "[records]") {
  const std::string text = record_text({"10,1,5,9,1,7", "10.25,3,5,9,1,7", "11,4,,8,1,7", "13.25,5,6,7,1,7"});
  const PlantRecord record = read_plant_record(study_with("most_missing = 0.6"), text, "r.csv");
  REQUIRE(record.samples() == 4);
  CHECK(record.y(0, 0) == 2.0);  // the mean of both rows within half a second
  CHECK(record.y(0, 1) == 4.0);
  CHECK(std::isnan(record.y(0, 2)));
  CHECK(record.y(0, 3) == 5.0);
  CHECK(std::isnan(record.y(1, 1)));
  CHECK(record.u.row(0) == Eigen::RowVector4d(9, 8, 8, 7));  // held
  CHECK(record.y_set.array().isNaN().all());
  CHECK(record.stamps == std::vector<std::string>{"10", "11", "12", "13"});
  const PlantRecord nearest =
      read_plant_record(study_with("most_missing = 0.6\ncv_resampling = 'nearest'"), text, "r.csv");
  CHECK(nearest.y(0, 0) == 1.0);
}

TEST_CASE("modes hold until the next one, and say what operators had taken", "[records]") {
  std::string text = "time,level,heat,hot,cold,drain,HC.MODE,AI.IN\n";
  for (const char* row :
       {"0,1,5,9,1,7,AUTO,1", "1,2,6,9,1,7,,", "2,3,5,8,1,7,MAN,0.0", "3,4,5,8,1,7,,1.0", "4,3,6,9,1,7,Cas,"})
    text += std::string(row) + "\n";
  const PlantRecord record =
      read_plant_record(study_with("mode = {hot = 'HC.MODE', heat = 'AI.IN'}"), text, "r.csv");
  Eigen::MatrixXd u_off(2, 5), y_off(2, 5);
  u_off << 0, 0, 1, 1, 0, 0, 0, 0, 0, 0;
  y_off << 0, 0, 0, 0, 0, 0, 0, 1, 0, 0;
  CHECK(record.u_off == u_off);
  CHECK(record.y_off == y_off);
  CHECK(!record.y.hasNaN());  // a CV that is off is measured
  CHECK(record.warnings ==
        std::vector<std::string>{
            "hot is off in 40 % of the samples, in which 'HC.MODE' is none of data.mode_on (1, "
            "on, true, auto, cas, rcas, rout)",
            "heat is off in 20 % of the samples, in which 'AI.IN' is none of data.mode_on (1, "
            "on, true, auto, cas, rcas, rout)"});
  const PlantRecord manual =
      read_plant_record(study_with("mode = {hot = 'HC.MODE'}\nmode_on = ['man']"), text, "r.csv");
  CHECK(manual.u_off.row(0) == (1.0 - u_off.row(0).array()).matrix());
  CHECK(manual.y_off.size() == 0);
  CHECK_THROWS_WITH(read_plant_record(study_with("mode = {hot = 'HC.MOD'}"), text, "r.csv"),
                    Catch::Contains("r.csv: data.mode.hot: found no column 'HC.MOD'"));
  text = "time,level,heat,hot,cold,drain,HC.MODE\n0,1,5,9,1,7,\n1,2,6,9,1,7,\n2,3,5,8,1,7,\n";
  CHECK_THROWS_WITH(
      read_plant_record(study_with("mode = {hot = 'HC.MODE'}"), text, "r.csv"),
      "r.csv: data.mode.hot: found no value in 'HC.MODE'; allowed: a word of data.mode_on where the "
      "controller has hot");
}

TEST_CASE("a row without the controller is one of which nothing was recorded", "[records]") {
  const std::string by_column =
      "time,level,heat,hot,cold,drain,on\n0,1,5,9,1,7,1\n1,2,5,8,1,7,1\n2,90,6,0,0,0,0\n3,95,6,0,0,0,0\n"
      "4,3,5,7,1,6,1\n5,4,5,6,1,6,1\n";
  const std::string by_modes =
      "time,level,heat,hot,cold,drain,H,C\n0,1,5,9,1,7,auto,auto\n1,2,5,8,1,7,auto,auto\n"
      "2,90,6,0,0,0,man,man\n3,95,6,0,0,0,man,man\n4,3,5,7,1,6,auto,auto\n5,4,5,6,1,6,auto,man\n";
  for (const auto& [text, data] : {std::pair{by_column, "controller_on = 'on'\nmost_missing = 0.5"},
                                   {by_modes, "mode = {hot = 'H', cold = 'C'}\nmost_missing = 0.5"}}) {
    const PlantRecord record = read_plant_record(study_with(data), text, "r.csv");
    CHECK(record.y.middleCols(2, 2).array().isNaN().all());
    CHECK_FALSE(record.y.col(4).hasNaN());
    for (const Eigen::Index k : {2, 3}) {
      CHECK(record.u.col(k) == record.u.col(1));
      CHECK(record.d.col(k) == record.d.col(1));
      CHECK_FALSE(record.has_mv_off(0, k));
    }
    CHECK(std::any_of(record.warnings.begin(), record.warnings.end(), [](const std::string& warning) {
      return warning.find("the controller is off in 33.3 % of the samples: they do not count") == 0;
    }));
  }
  CHECK(read_plant_record(study_with("mode = {hot = 'H', cold = 'C'}\nmost_missing = 0.5"), by_modes, "r.csv")
            .has_mv_off(1, 5));
  CHECK_THROWS_WITH(
      read_plant_record(study_with("mode = {hot = 'H', cold = 'C'}\nmode_on = ['cas']"), by_modes, "r.csv"),
      Catch::Contains("no row in which the controller has an MV"));
}

TEST_CASE("setpoints and modes that nothing names are pointed out", "[records]") {
  const std::string text =
      "time,level,heat,heat.SP,hot,hot.MODE,cold,drain\n0,1,5,5,9,auto,1,7\n1,2,6,4,8,auto,1,7\n";
  const auto told = [&text](const std::string& data) {
    std::string all;
    for (const std::string& warning : read_plant_record(study_with(data), text, "r.csv").warnings)
      all += warning + "\n";
    return all;
  };
  CHECK_THAT(told(""), Catch::Contains("data.mode = {hot = \"hot.MODE\"}"));
  CHECK_THAT(told("mode = {hot = 'hot.MODE'}"), !Catch::Contains("data.mode = "));
  CHECK_THAT(told("candidates = ['heat.SP']"), !Catch::Contains("data.setpoint = "));
}

TEST_CASE("values are deviations in the unit of the study", "[records]") {
  const std::string text = record_text({"0,81,5,9,1,7", "1,82,5,9,1,7", "2,83,5,9,1,7"});
  const PlantRecord record = read_plant_record(
      study_with("operating_point = {level = 80}\nscale = {level = 0.5}\nsetpoint = {level = 'heat'}\n"
                 "period = ['1', '2']\nbenchmark = ['2', '9']"),
      text, "r.csv");
  CHECK(record.y.row(0) == Eigen::RowVector2d(1.0, 1.5));
  CHECK(record.y_set.row(0) == Eigen::RowVector2d::Constant(-37.5));  // recorded as the CV is
  CHECK(record.benchmark == std::pair<Eigen::Index, Eigen::Index>{1, 2});
}

bool warns(const PlantRecord& record, const std::string& text) {
  return std::any_of(record.warnings.begin(), record.warnings.end(),
                     [&](const std::string& warning) { return warning.find(text) != std::string::npos; });
}

TEST_CASE("what cannot be measured is missing, with a warning", "[records]") {
  std::vector<std::string> rows;
  for (int k = 0; k < 40; ++k)
    rows.push_back(fmt::format("{},{},5,{},1,7", k, k == 20 || k == 21 ? "-9999.0" : fmt::format("{}", k % 7),
                               k == 30 ? "1e30" : fmt::format("{}", k % 3)));
  const PlantRecord record = read_plant_record(
      study_with("operating_point = {level = 3}\nscale = {level = 2}"), record_text(rows), "r.csv");
  CHECK(record.y.row(0).array().isNaN().count() == 2);
  CHECK((std::isnan(record.y(0, 20)) && std::isnan(record.y(0, 21))));
  CHECK(record.u(0, 30) == record.u(0, 29));
  CHECK(warns(record,
              "column 'level': 2 values cannot be measurements and count as missing, the first is "
              "'-9999.0' in line 22"));
}

TEST_CASE("dates are found under any heading, and in numbers of seconds", "[records]") {
  const auto read = [](const std::string& heading, const std::string& begin, const std::string& data = "") {
    return read_plant_record(study_with(data),
                             heading + ",level,heat,hot,cold,drain\n" + begin + "0,1,5,9,1,7\n" + begin +
                                 "1,2,6,9,1,7\n" + begin + "2,3,7,9,1,7\n",
                             "r.csv");
  };
  for (const char* heading : {"", "Timestamp (UTC)"})
    CHECK(read(heading, "2024-03-01 12:00:0").stamps.back() == "2024-03-01 12:00:02");
  CHECK(read("time", "170925120").stamps.back() == "2024-03-01 00:00:02");
  CHECK(read("time", "170925120", "period = ['2024-03-01', '2024-03-01 00:00:01']").samples() == 2);
  CHECK(read("time", "170925120", "period = ['1709251200', '1709251201']").samples() == 2);
  CHECK_THROWS_WITH(
      read_plant_record(study_with(""), "a,b,level,heat,hot,cold,drain\n2024-03-01,2024-03-01,1,1,1,1,1\n",
                        "r.csv"),
      Catch::Contains("found dates in the columns 'a' and 'b'; allowed: data.time"));
  CHECK_THROWS_WITH(
      read_plant_record(study_with(""), record_text({"-1e308,1,5,9,1,7", "1e308,2,5,9,1,7"}), "r.csv"),
      Catch::Contains("inf samples of"));
  CHECK(read("time", "", "period = ['0', '1']").samples() == 2);
  CHECK(read_plant_record(study_with("period = ['0', '1']"),
                          record_text({"0,1,5,9,1,7", "1,2,6,9,1,7", "1e300,3,7,9,1,7"}), "r.csv")
            .samples() == 2);
}

TEST_CASE("qualities that are not good are named, and numbers are known in any form", "[records]") {
  std::string text = "time,level,heat,hot,cold,drain,q\n";
  for (int k = 0; k < 10; ++k)
    text += fmt::format("{},{},{},9,1,7,{}\n", k, k, k + 1, k == 4 ? "24.0" : k == 5 ? "Bad" : "192.0");
  const PlantRecord record = read_plant_record(study_with("quality = {level = 'q'}"), text, "r.csv");
  CHECK(record.y.row(0).array().isNaN().count() == 2);
  CHECK(warns(record,
              "level is missing in 2 of 10 rows, whose quality is none of data.good_quality (good, "
              "opc): '24.0' (1 rows), 'Bad' (1 rows)"));
}

TEST_CASE("a quality that nothing names is used where it can be nothing else, and told otherwise",
          "[records]") {
  const auto read = [](const std::string& heading, const std::vector<std::string>& words,
                       const std::string& data = "") {
    std::string text = "time,level,heat,hot,cold,drain," + heading + "\n";
    for (int k = 0; k < 20; ++k)
      text += fmt::format("{},{},{},9,1,7,{}\n", k, k, k + 1, k < 18 ? words[0] : words[1]);
    return read_plant_record(study_with(data), text, "r.csv");
  };
  const auto missing = [](const PlantRecord& record) { return record.y.row(0).array().isNaN().count(); };
  const PlantRecord bad = read("level.Status", {"Good", "Bad"});
  CHECK(missing(bad) == 2);
  CHECK(warns(bad,
              "level is missing in 2 of 20 rows, the first in line 20, in which the column "
              "'level.Status' has none of data.good_quality (good, opc): 'Bad' (2 rows). Nothing names this "
              "column: data.quality = {level = \"level.Status\"} does"));
  CHECK(missing(read("Quality", {"192", "24"})) == 2);
  const PlantRecord other = read("level.Status", {"OK", "FAULT"});
  CHECK(missing(other) == 0);
  CHECK(warns(other,
              "level: the column 'level.Status' has 'FAULT' (2 rows), 'OK' (18 rows), the first in line 2. "
              "If this is its quality, name the column in data.quality"));
  CHECK(missing(read("level.Status", {"OK", "FAULT"}, "good_quality = ['ok']")) == 0);
  CHECK(missing(read("level.Status", {"Good", "Uncertain"}, "good_quality = ['good', 'uncertain']")) == 0);
  for (const PlantRecord& quiet :
       {read("level.Status", {"Good", "Good"}), read("level.Status", {"OK", "OK"}),
        read("Status", {"RUN", "STOP"}),
        read("level.Q", {"1.5", "2.5"}, "mode = {level = 'level.Q'}\nmode_on = ['1.5', '2.5']"),
        read("heat2.Status", {"Good", "Bad"})}) {
    CHECK(missing(quiet) == 0);
    CHECK_FALSE(warns(quiet, ".Status"));
    CHECK_FALSE(warns(quiet, "quality"));
  }
  std::string text = "tag,time,value,Status\n";
  for (int k = 0; k < 20; ++k)
    for (const char* tag : {"level", "heat", "hot", "cold", "drain"})
      text += fmt::format("{},{},{},{}\n", tag, k, k == 3 && *tag == 'l' ? 1000 : k,
                          k == 3 && *tag == 'l' ? "Bad" : "Good");
  const PlantRecord of_long = read_plant_record(study_with(""), text, "r.csv");
  CHECK(missing(of_long) == 1);
  CHECK(warns(of_long, "the first in line 17, in which the column 'level.Status'"));
}

TEST_CASE("what a record lacks is said by name", "[records]") {
  const std::string text = record_text({"0,1,5,9,1,7", "1,,5,9,1,7", "2,,5,9,1,7"});
  CHECK_THROWS_WITH(read_plant_record(study_with(""), text, "r.csv"),
                    Catch::Contains("r.csv: level: found 66.7 % of its samples missing") &&
                        Catch::Contains("data.most_missing"));
  CHECK_THROWS_WITH(read_plant_record(study_with("quality = {heat = 'q'}"), text, "r.csv"),
                    Catch::Contains("data.quality.heat: found no column 'q'"));
  CHECK_THROWS_WITH(read_plant_record(study_with("period = ['5', '9']"), text, "r.csv"),
                    Catch::Contains("data.period") || Catch::Contains("data.time_unit"));
  CHECK_THROWS_WITH(
      read_plant_record(study_with(""),
                        "time,level,level,heat,hot,cold,drain\n0,1,1,1,1,1,1\n1,1,1,1,1,1,1\n", "r.csv"),
      Catch::Contains("column 'level': found two columns of this name"));
  CHECK_THROWS_WITH(read_plant_record(study_with(""), record_text({"0,a,5,9,1,7", "1,b,5,9,1,7"}), "r.csv"),
                    Catch::Contains("column 'level', for level: found no number, but 'a'"));
}

}  // namespace
}  // namespace mpm
