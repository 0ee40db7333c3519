// [data]

#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/study_files/study_file_parts.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

using Variables = std::function<std::vector<std::string>()>;

/// A table with a value for some of the variables.
template <class Value, class Read>
OptionKey group(const char* name, const char* type, std::map<std::string, Value>& group, Variables variables,
                Read read_value, const char* meaning) {
  const auto read = [&group, variables = std::move(variables), read_value](const TomlTable& data,
                                                                           const std::string& key) {
    const TomlTable table = data.table(key, variables());
    for (const std::string& variable : table.present_keys())
      group[variable] = read_value(table, variable);
  };
  return key::option(name, type, meaning).read(read);
}

OptionKey columns(const char* name, DataOptions::Names& names, Variables variables, const char* meaning) {
  return group(
      name, "table of texts", names, std::move(variables),
      [](const TomlTable& table, const std::string& key) { return read_text(table, key); }, meaning);
}

OptionKey factors(const char* name, DataOptions::Numbers& numbers, Variables variables, const char* meaning) {
  return group(
      name, "table of numbers", numbers, std::move(variables),
      [](const TomlTable& table, const std::string& key) {
        return read_number(table, key, NumberRule::finite());
      },
      meaning);
}

/// A key whose value is one of `words`.
OptionKey one_word(const char* name, std::string& value, std::vector<std::string> words,
                   const char* meaning) {
  return key::option(name, "text", meaning)
      .read([&value, words = std::move(words)](const TomlTable& table, const std::string& key) {
        value = words[read_one_of(table, key, words)];
      });
}

/// Reads two time stamps.
std::vector<std::string> read_period(const TomlTable& data, const std::string& key) {
  std::vector<std::string> stamps = read_texts_or(data, key, "time stamps as texts, first and last", {});
  if (stamps.size() != 2)
    data.refuse(key, "another number of time stamps", "two, the first and the last");
  return stamps;
}

/// Reads the lines to skip: the number of first lines, or a list of lines.
std::vector<int> read_skipped(const TomlTable& data, const std::string& key) {
  constexpr int kMostLines = 1000;
  const NumberRule rule{.low = 1, .high = kMostLines, .low_included = true, .high_included = true};
  std::vector<int> lines;
  if (data.find(key)->is_integer()) {
    lines.resize(static_cast<std::size_t>(read_whole(data, key, 1, kMostLines)));
    std::iota(lines.begin(), lines.end(), 1);
  } else {
    for (const double line : read_numbers(data, key, rule, kMostLines)) {
      if (line != std::floor(line))
        data.refuse(key, fmt::format("{}", line), "whole numbers");
      lines.push_back(static_cast<int>(line));
    }
    data.record(key, lines);
  }
  return lines;
}

OptionKeys data_keys(Study& study) {
  DataOptions& o = study.data;
  const Variables cvs = [&study] { return variable_names(study.plant.cvs); };
  const Variables mvs = [&study] { return variable_names(study.plant.mvs); };
  const Variables loop = [&study] {
    std::vector<std::string> names = variable_names(study.plant.cvs);
    for (const std::string& mv : variable_names(study.plant.mvs))
      names.push_back(mv);
    return names;
  };
  const Variables all = [&study] {
    std::vector<std::string> names = variable_names(study.plant.cvs);
    for (const std::string& input : input_names(study.plant))
      names.push_back(input);
    return names;
  };
  const auto refuse_zero = [&o](const TomlTable& data) {
    for (const auto& [name, factor] : o.scale)
      if (factor == 0.0)
        data.refuse("scale", name + " = 0", "factors that are not 0");
  };
  const auto read_benchmark = [&o](const TomlTable& data, const std::string& key) {
    if (data.find(key)->is_string())
      o.benchmark = {std::vector<std::string>{"found", "none"}[read_one_of(data, key, {"found", "none"})]};
    else
      o.benchmark = read_period(data, key);
  };
  return {
      key::text("time", o.time, "column of the time stamps")
          .otherwise("`time`, `timestamp`, `datetime`, `date` or `t`, or the one column of dates; none: each "
                     "row is a sample")
          .allow("a column"),
      key::text("date", o.date, "column of the dates, if the column of the time has only the time of day")
          .otherwise("the one column of dates")
          .allow("a column"),
      one_word("time_unit", o.time_unit, {"s", "min", "h", "d", "ms", "us", "ns", "spreadsheet", "matlab"},
               "unit of stamps that are numbers. s, ms, us and ns since 1970, days since 1899-12-30 "
               "(`\"spreadsheet\"`) and `datenum` (`\"matlab\"`) give dates")
          .otherwise("found, if the numbers can only be dates of the years 2000 to 2099; else that of the "
                     "plant")
          .allow("`\"s\"`, `\"min\"`, `\"h\"`, `\"d\"`, `\"ms\"`, `\"us\"`, `\"ns\"`, "
                 "`\"spreadsheet\"`, `\"matlab\"`"),
      key::text("time_format", o.time_format,
                "form of the stamps in the letters of strptime, such as `\"%d%b%Y:%H:%M:%S\"`; it must cover "
                "the whole stamp")
          .otherwise("found")
          .allow("`%Y %y %m %b %d %H %I %M %S %p %z %Z %j` and others"),
      key::text("time_zone", o.time_zone,
                "time zone of the stamps, such as `\"Europe/Berlin\"`; its clock changes are removed")
          .otherwise("stamps are taken as they stand")
          .allow("a name of the IANA time zone database"),
      key::text("language", o.language,
                "language of the names of months and of the words for before and after noon in the stamps, "
                "such as `\"it\"` or `\"pt_BR\"`")
          .otherwise("found, if the words mean the same in all languages that have them")
          .allow("a language of CLDR"),
      key::choice("date_order", o.date_order,
                  {"automatic", "year-month-day", "day-month-year", "month-day-year"},
                  "order of day, month and year; detected from numbers above 12 or points between them"),
      key::option("skip", "whole number, or list of whole numbers",
                  "lines that are not read: the first ones (a number), or those with the listed numbers; "
                  "rows of units below the heading are detected")
          .otherwise("none")
          .allow("1 to 1000 (each)")
          .read([&o](const TomlTable& data, const std::string& key) { o.skip = read_skipped(data, key); }),
      key::choice("layout", o.layout, {"automatic", "wide", "time-per-tag", "long"},
                  "`\"wide\"`: one row for each time stamp. `\"time-per-tag\"`: a column of stamps before "
                  "each column of values. `\"long\"`: one row for each value. `\"automatic\"`: time-per-tag "
                  "if several columns of stamps have the same name; long if there are columns with usual "
                  "names for a tag and a value, and none for a variable"),
      key::text("tag_column", o.tag_column, "column of the tags, if a row is a value")
          .otherwise("`tag`, `tagname`, `point`, `variable`, `name` and others")
          .allow("a column"),
      key::text("value_column", o.value_column, "column of the values, if a row is a value")
          .otherwise("`value`, `val`, `wert`, `reading`")
          .allow("a column"),
      one_word("separator", o.separator, {",", ";", "\t", "|"}, "separator between the columns")
          .otherwise("found in the heading")
          .allow("`\",\"`, `\";\"`, `\"\\t\"`, `\"|\"`"),
      one_word("decimal", o.decimal, {".", ","}, "decimal sign")
          .otherwise("found in the cells")
          .allow("`\".\"`, `\",\"`"),
      columns("tags", o.tags, all, "columns of CVs, MVs and MDs")
          .otherwise("`y.NAME`, `u.NAME`, `d.NAME`, or `NAME`")
          .allow("columns"),
      factors("operating_point", o.operating_point, all,
              "value that is 0 in the study, in the unit of the file")
          .otherwise("0")
          .allow("finite"),
      factors("scale", o.scale, all, "study value = scale (recorded value - operating point)")
          .otherwise("1")
          .allow("not 0"),
      key::check(refuse_zero),
      columns("setpoint", o.setpoint, cvs, "setpoints of the CVs that have one, with the scale of the CV")
          .otherwise("`y_set.NAME`; none: that of the study")
          .allow("columns"),
      columns("lower", o.lower, cvs,
              "lower soft limits of CVs over time, with the scale of the CV; within the hard limits")
          .otherwise("none: those of the study")
          .allow("columns"),
      columns("upper", o.upper, cvs, "upper soft limits, in the same way")
          .otherwise("none: those of the study")
          .allow("columns"),
      columns("y_sim", o.y_sim, cvs, "output of the model for a CV, with the scale of the CV")
          .otherwise("none: computed from MVs and MDs")
          .allow("columns"),
      columns("target", o.target, mvs, "targets of MVs, with the scale of the MV")
          .otherwise("`u_target.NAME`; none")
          .allow("columns"),
      columns("quality", o.quality, all, "quality of any variable, row by row")
          .otherwise("none: all is good")
          .allow("columns"),
      key::texts("good_quality", o.good_quality, "texts",
                 "words for a good quality, in upper or lower case; numbers match in any form (`192.0`). "
                 "`opc`: words that begin with good, and the good codes of OPC: those of OPC UA if a code is "
                 "2^30 or above, otherwise those of OPC DA (192 and others)"),
      columns("mode", o.mode, loop,
              "whether the controller has a CV or an MV, over time; each value holds until the next one. "
              "While the controller does not have it, operators hold the MV where it was recorded, and the "
              "CV has no limits and no setpoint")
          .otherwise("none: the controller has all of them")
          .allow("columns"),
      key::texts("mode_on", o.mode_on, "texts",
                 "words of `mode` for a variable that the controller has, in upper or lower case; numbers "
                 "match in any form"),
      key::option("stored_on_change", "list of texts",
                  "variables that were stored only when they changed: each value holds until the next one, "
                  "and no sample in between is missing")
          .otherwise("none")
          .allow("variables")
          .read([&o, all](const TomlTable& data, const std::string& key) {
            const std::vector<std::string> names = all();
            for (const std::size_t place : read_some_of(data, key, names))
              o.stored_on_change.push_back(names[place]);
          }),
      key::text("controller_on", o.controller_on,
                "whether the controller is on; CVs are not judged while it is off")
          .otherwise("none: always on")
          .allow("a column"),
      key::texts("on_values", o.on_values, "texts",
                 "words for a controller that is on, in upper or lower case"),
      key::choice("cv_resampling", o.cv_resampling, {"mean", "nearest"},
                  "value of a CV at a sample, from the rows within half a sample time of it"),
      key::choice("start", o.start, {"automatic", "rest", "anywhere"},
                  "whether the record begins at rest at the operating point. `\"automatic\"`: yes if MVs and "
                  "MDs begin within half of their standard deviations of it. `\"anywhere\"`: no, and CVs are "
                  "not judged until the slowest channel has settled"),
      key::number("most_missing", o.most_missing, NumberRule::inside(0, 1),
                  "largest share of the samples of a variable that may be missing"),
      key::texts("candidates", o.candidates, "columns",
                 "signals outside the model, for the method `candidates`: inputs that the model may lack")
          .allow("columns"),
      fill_key(
          o.fill,
          "value of a missing CV for methods that need every sample. `\"none\"`: no value, so these methods "
          "do not apply. `\"hold\"`: the last value. `\"linear\"`: a straight line. Methods that can handle "
          "gaps see the gaps"),
      key::option("period", "list of 2 texts", "period that is assessed")
          .otherwise("the whole file")
          .allow("stamps as in the file")
          .read([&o](const TomlTable& data, const std::string& key) { o.period = read_period(data, key); }),
      key::option("benchmark", "list of 2 texts, or text",
                  "period in which the controller worked as designed, for the methods that need one")
          .otherwise("the simulated nominal loop")
          .allow("stamps as in the file; `\"found\"`; or `\"none\"`, with which `assess` proposes none")
          .read(read_benchmark)};
}

}  // namespace

OptionKey data_key(Study& study) {
  return key::optional_table(
             "data", [&study] { return data_keys(study); },
             "how `mpmbench assess` reads a file of records of the plant")
      .otherwise("columns have the names of the variables");
}

}  // namespace mpm
