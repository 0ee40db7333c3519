// [data]

#include <string>
#include <utility>
#include <vector>

#include "scenarios/files/study_file_parts.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

using Variables = std::function<std::vector<std::string>()>;

/// A table with something for some of the variables.
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

/// One of these texts.
OptionKey one_word(const char* name, std::string& value, std::vector<std::string> words,
                   const char* meaning) {
  return key::option(name, "text", meaning)
      .read([&value, words = std::move(words)](const TomlTable& table, const std::string& key) {
        value = words[read_one_of(table, key, words)];
      });
}

/// Two time stamps.
std::vector<std::string> read_period(const TomlTable& data, const std::string& key) {
  std::vector<std::string> stamps = read_texts_or(data, key, "time stamps as texts, first and last", {});
  if (stamps.size() != 2)
    data.refuse(key, "another number of time stamps", "two, the first and the last");
  return stamps;
}

OptionKeys data_keys(Study& study) {
  DataOptions& o = study.data;
  const Variables cvs = [&study] { return variable_names(study.plant.cvs); };
  const Variables mvs = [&study] { return variable_names(study.plant.mvs); };
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
      o.benchmark = {std::vector<std::string>{"found"}[read_one_of(data, key, {"found"})]};
    else
      o.benchmark = read_period(data, key);
  };
  return {
      key::text("time", o.time, "column of the time stamps")
          .otherwise("`time`, `timestamp`, `datetime`, `date` or `t`, or the one column of dates; none: a "
                     "row a sample")
          .allow("a column"),
      one_word("time_unit", o.time_unit, {"s", "min", "h", "d"}, "unit of stamps that are numbers")
          .otherwise("that of the plant")
          .allow("`\"s\"`, `\"min\"`, `\"h\"`, `\"d\"`"),
      key::choice("date_order", o.date_order,
                  {"automatic", "year-month-day", "day-month-year", "month-day-year"},
                  "order of day, month and year; detected from numbers above 12 or points between them"),
      one_word("separator", o.separator, {",", ";", "\t", "|"}, "between the columns")
          .otherwise("found in the heading")
          .allow("`\",\"`, `\";\"`, `\"\\t\"`, `\"|\"`"),
      one_word("decimal", o.decimal, {".", ","}, "decimal sign")
          .otherwise("found in the cells")
          .allow("`\".\"`, `\",\"`"),
      columns("tags", o.tags, all, "of CVs, MVs and MDs")
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
                 "words for a good quality, in upper or lower case; numbers count in any form (`192.0`)"),
      key::text("controller_on", o.controller_on,
                "whether the controller is on; CVs are not judged while it is off")
          .otherwise("none: always on")
          .allow("a column"),
      key::texts("on_values", o.on_values, "texts",
                 "words for a controller that is on, in upper or lower case"),
      key::choice("cv_resampling", o.cv_resampling, {"mean", "nearest"},
                  "value of a CV at a sample, of the rows within half a sample time of it"),
      key::choice("start", o.start, {"automatic", "rest", "anywhere"},
                  "whether the record begins at rest at the operating point. Automatic: yes if MVs and MDs "
                  "begin within half of their standard deviations of it. Anywhere: CVs are not judged until "
                  "the slowest channel has settled"),
      key::number("most_missing", o.most_missing, NumberRule::inside(0, 1),
                  "largest share of the samples of a variable that may be missing"),
      key::texts("candidates", o.candidates, "columns",
                 "signals outside the model, for the method `candidates`: inputs that the model may lack")
          .allow("columns"),
      fill_key(o.fill,
               "what methods that need every sample get for a missing CV: nothing, so that they do not "
               "apply; the last value; or a straight line. Methods that can handle gaps see them. The loops "
               "of the calibration run are filled if the first method needs it"),
      key::option("period", "list of 2 texts", "what is assessed")
          .otherwise("the whole file")
          .allow("stamps as in the file")
          .read([&o](const TomlTable& data, const std::string& key) { o.period = read_period(data, key); }),
      key::option("benchmark", "list of 2 texts, or text",
                  "period in which the controller worked as designed, for the methods that need one")
          .otherwise("the simulated nominal loop")
          .allow("stamps as in the file, or `\"found\"`")
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
