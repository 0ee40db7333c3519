#include <string>
#include <string_view>
#include <vector>

#include "scenarios/files/study_file_keys.hpp"
#include "scenarios/files/study_file_parts.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

/// The table under `key`, a column for some of the variables `names`.
DataOptions::Names read_columns(const TomlTable& data, std::string_view key,
                                const std::vector<std::string>& names) {
  DataOptions::Names columns;
  const TomlTable table = data.table_or_empty(key, names);
  for (const std::string& name : names)
    if (table.has(name))
      columns[name] = read_text(table, name);
  return columns;
}

DataOptions::Numbers read_factors(const TomlTable& data, std::string_view key,
                                  const std::vector<std::string>& names, const NumberRule& rule) {
  DataOptions::Numbers numbers;
  const TomlTable table = data.table_or_empty(key, names);
  for (const std::string& name : names)
    if (table.has(name))
      numbers[name] = read_number(table, name, rule);
  return numbers;
}

/// Two time stamps; none without the key.
std::vector<std::string> read_period(const TomlTable& data, std::string_view key) {
  if (!data.has(key))
    return {};
  std::vector<std::string> stamps = read_texts_or(data, key, "time stamps as texts, first and last", {});
  if (stamps.size() != 2)
    data.refuse(key, "another number of time stamps", "two, the first and the last");
  return stamps;
}

/// Two time stamps, or "found" alone.
std::vector<std::string> read_benchmark_period(const TomlTable& data) {
  const toml::node* const node = data.find("benchmark");
  if (node == nullptr || !node->is_string())
    return read_period(data, "benchmark");
  read_one_of(data, "benchmark", {"found"});
  return {"found"};
}

/// One of these characters; empty without the key.
std::string read_character(const TomlTable& data, std::string_view key,
                           const std::vector<std::string>& allowed) {
  return data.has(key) ? allowed[read_one_of(data, key, allowed)] : std::string();
}

}  // namespace

DataOptions read_data(const TomlTable& document, const Study& study) {
  DataOptions options;
  if (!document.has("data"))
    return options;
  const TomlTable data = document.table("data", study_file_keys("data"));
  const std::vector<std::string> cvs = variable_names(study.plant.cvs);
  const std::vector<std::string> mvs = variable_names(study.plant.mvs);
  std::vector<std::string> all = cvs;
  all.insert(all.end(), mvs.begin(), mvs.end());
  for (const std::string& md : variable_names(study.plant.mds))
    all.push_back(md);

  options.time = read_text_or(data, "time", "");
  options.time_unit = read_character(data, "time_unit", {"s", "min", "h", "d"});
  options.date_order = read_choice_or<DateOrder>(data, "date_order",
                                                 {{"automatic", DateOrder::automatic},
                                                  {"year-month-day", DateOrder::year_month_day},
                                                  {"day-month-year", DateOrder::day_month_year},
                                                  {"month-day-year", DateOrder::month_day_year}},
                                                 options.date_order);
  options.separator = read_character(data, "separator", {",", ";", "\t", "|"});
  options.decimal = read_character(data, "decimal", {".", ","});
  options.tags = read_columns(data, "tags", all);
  options.operating_point = read_factors(data, "operating_point", all, NumberRule::finite());
  options.scale = read_factors(data, "scale", all, NumberRule::finite());
  for (const auto& [name, factor] : options.scale)
    if (factor == 0.0)
      data.refuse("scale", name + " = 0", "factors that are not 0");
  options.setpoint = read_columns(data, "setpoint", cvs);
  options.lower = read_columns(data, "lower", cvs);
  options.upper = read_columns(data, "upper", cvs);
  options.y_sim = read_columns(data, "y_sim", cvs);
  options.target = read_columns(data, "target", mvs);
  options.quality = read_columns(data, "quality", all);
  options.good_quality = read_texts_or(data, "good_quality", "texts", options.good_quality);
  options.controller_on = read_text_or(data, "controller_on", "");
  options.on_values = read_texts_or(data, "on_values", "texts", options.on_values);
  options.cv_resampling = read_choice_or<CvResampling>(
      data, "cv_resampling", {{"mean", CvResampling::mean}, {"nearest", CvResampling::nearest}},
      options.cv_resampling);
  options.start = read_choice_or<RecordStart>(data, "start",
                                              {{"automatic", RecordStart::automatic},
                                               {"rest", RecordStart::rest},
                                               {"anywhere", RecordStart::anywhere}},
                                              options.start);
  options.most_missing = read_number_or(data, "most_missing", NumberRule::inside(0, 1), options.most_missing);
  if (data.has("candidates"))
    options.candidates = read_texts_or(data, "candidates", "columns", {});
  options.fill = read_gap_fill_or(data, "fill", options.fill);
  options.period = read_period(data, "period");
  options.benchmark = read_benchmark_period(data);
  return options;
}

}  // namespace mpm
