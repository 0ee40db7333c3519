#include "results/blind/verdict_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "analysis/methods/method_messages.hpp"
#include "analysis/methods/method_table.hpp"
#include "plants/error.hpp"
#include "plants/input_file.hpp"
#include "results/blind/blind_loops.hpp"

namespace mpm {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> known_columns(const PlantModel& plant) {
  std::vector<std::string> columns{"loop",      "flagged", "score", "cv",    "source", "channels",
                                   "parameter", "size",    "lower", "upper", "error"};
  for (const char* of_cv : {"cv_flagged", "cv_score", "cv_source"})
    for (const PlantModel::Variable& cv : plant.cvs)
      columns.push_back(fmt::format("{}.{}", of_cv, cv.name));
  return columns;
}

std::string trimmed_cell(const std::string& text) {
  const auto begin = text.find_first_not_of(" \t\r\n");
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1);
}

/// The fields of a line of CSV; a field in quotes may have commas and doubled quotes, but no end of line.
std::vector<std::string> verdict_fields(const std::string& line, const std::string& place) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
      fields.back() += line[++i];
    else if (line[i] == '"')
      quoted = !quoted;
    else if (line[i] == ',' && !quoted)
      fields.emplace_back();
    else
      fields.back() += line[i];
  }
  if (quoted)
    throw InputError(place, "a quote that is not closed on its line", "a line of CSV");
  std::transform(fields.begin(), fields.end(), fields.begin(), trimmed_cell);
  return fields;
}

/// One line of the file: its fields that are not empty, by their columns.
struct VerdictLine {
  std::string place;  ///< "FILE:LINE"
  std::map<std::string, std::string> fields;

  const std::string* find(const std::string& column) const {
    const auto found = fields.find(column);
    return found == fields.end() ? nullptr : &found->second;
  }
  [[noreturn]] void refuse(const std::string& column, const std::string& allowed) const {
    throw InputError(fmt::format("{}: {}", place, column), fmt::format("'{}'", fields.at(column)), allowed);
  }
};

struct VerdictText {
  std::optional<std::string> hash;
  std::vector<std::string> columns;
  std::vector<VerdictLine> lines;

  bool has(std::string_view column) const {
    return std::find(columns.begin(), columns.end(), column) != columns.end();
  }
  /// Some line says something in a column that begins so.
  bool uses(std::string_view begin) const {
    return std::any_of(lines.begin(), lines.end(), [&](const VerdictLine& line) {
      const auto first = line.fields.lower_bound(std::string(begin));
      return first != line.fields.end() && first->first.starts_with(begin);
    });
  }
};

void take_heading(VerdictText& text, std::vector<std::string> columns, const std::string& place,
                  const PlantModel& plant) {
  const std::vector<std::string> known = known_columns(plant);
  for (const std::string& column : columns)
    if (std::find(known.begin(), known.end(), column) == known.end() ||
        std::count(columns.begin(), columns.end(), column) > 1)
      throw InputError(place, fmt::format("column '{}'", column),
                       fmt::format("each once: {}", fmt::join(known, ", ")));
  text.columns = std::move(columns);
  if (!text.has("loop") || !text.has("flagged"))
    throw InputError(place, fmt::format("columns {}", fmt::join(text.columns, ",")),
                     "at least loop and flagged in the heading line");
}

VerdictText read_verdict_text(const std::filesystem::path& path, const PlantModel& plant) {
  std::ifstream file = open_input(path, "a CSV file of verdicts");
  const std::string kHash = trimmed_cell(hash_line(""));
  VerdictText text;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::string place = fmt::format("{}:{}", path.string(), number);
    line = trimmed_cell(line);
    if (line.starts_with(kHash))
      text.hash = trimmed_cell(line.substr(kHash.size()));
    if (line.empty() || line.starts_with('#'))
      continue;
    std::vector<std::string> fields = verdict_fields(line, place);
    if (text.columns.empty()) {
      take_heading(text, std::move(fields), place, plant);
      continue;
    }
    if (fields.size() != text.columns.size())
      throw InputError(place, fmt::format("{} fields", fields.size()),
                       fmt::format("{}, as the heading has", text.columns.size()));
    VerdictLine verdict{place, {}};
    for (std::size_t i = 0; i < fields.size(); ++i)
      if (!fields[i].empty())
        verdict.fields.emplace(text.columns[i], std::move(fields[i]));
    text.lines.push_back(std::move(verdict));
  }
  if (text.columns.empty())
    throw InputError(path.string(), "no line", "a heading line and a line for each loop");
  return text;
}

template <class Number>
std::optional<Number> number_in(const std::string& text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

Json flag_json(const VerdictLine& line, const std::string& column) {
  const std::string* const field = line.find(column);
  if (field == nullptr)
    return nullptr;
  for (const char* yes : {"1", "true", "yes"})
    if (*field == yes)
      return true;
  for (const char* no : {"0", "false", "no"})
    if (*field == no)
      return false;
  line.refuse(column, "1, 0, true, false, yes, no, or nothing for no verdict");
}

Json number_json(const VerdictLine& line, const std::string& column) {
  const std::string* const field = line.find(column);
  if (field == nullptr)
    return nullptr;
  const std::optional<double> value = number_in<double>(*field);
  if (!value)
    line.refuse(column, "a number");
  if (std::isinf(*value))
    return *value > 0 ? "Infinity" : "-Infinity";
  return *value;
}

Json text_json(const VerdictLine& line, const std::string& column) {
  const std::string* const field = line.find(column);
  return field == nullptr ? Json() : Json(*field);
}

/// "y1/u2 y3/u1"
Json channels_json(const VerdictLine& line) {
  Json channels = Json::array();
  const std::string* const field = line.find("channels");
  std::istringstream words(field == nullptr ? "" : *field);
  for (std::string word; words >> word;) {
    const auto slash = word.find('/');
    if (slash == std::string::npos)
      line.refuse("channels", "channels CV/MV, with blanks between them: y1/u2 y3/u1");
    channels.push_back({word.substr(0, slash), word.substr(slash + 1)});
  }
  return channels;
}

/// The answer that a program would give in the place of this line.
Json answer_json(const VerdictLine& line, const PlantModel& plant, const MethodDescription& method) {
  if (const std::string* const error = line.find("error"))
    return {{"error", *error}};
  if (line.find("flagged") == nullptr)
    return {{"error", "the file of verdicts says nothing of this loop"}};
  Json answer{{"flagged", flag_json(line, "flagged")}, {"score", number_json(line, "score")}};
  if (method.locates_cvs)
    answer["cv"] = text_json(line, "cv");
  if (method.tells_sources)
    answer["source"] = text_json(line, "source");
  const auto by_cv = [&](const std::string& name, Json (*read)(const VerdictLine&, const std::string&)) {
    Json list = Json::array();
    for (const PlantModel::Variable& cv : plant.cvs)
      list.push_back(read(line, fmt::format("{}.{}", name, cv.name)));
    return std::all_of(list.begin(), list.end(), [](const Json& each) { return each.is_null(); }) ? Json()
                                                                                                  : list;
  };
  if (method.locates_cvs) {
    answer["cv_flagged"] = by_cv("cv_flagged", flag_json);
    answer["cv_score"] = by_cv("cv_score", number_json);
    answer["cv_source"] = by_cv("cv_source", text_json);
  }
  const Json channels = channels_json(line);
  if (method.names_channels)
    answer["channels"] = channels;
  if (line.find("parameter") != nullptr) {
    if (channels.empty())
      line.refuse("parameter", "nothing without a channel in the column `channels`");
    answer["mismatch"] = {{"channel", channels[0]},
                          {"parameter", text_json(line, "parameter")},
                          {"size", number_json(line, "size")},
                          {"lower", number_json(line, "lower")},
                          {"upper", number_json(line, "upper")}};
  }
  return answer;
}

void require_name(const std::string& name) {
  const std::vector<std::string> known = assessment_method_names();
  const auto is_fit = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  };
  if (name.empty() || !std::all_of(name.begin(), name.end(), is_fit) ||
      std::find(known.begin(), known.end(), name) != known.end())
    throw InputError(
        "--verdicts", fmt::format("the name '{}'", name),
        "NAME=FILE with letters, digits, '-' and '_' in a name that no method of this program has");
}

MethodDescription description_of(const VerdictText& text, const std::string& name, const std::string& file) {
  MethodDescription method;
  method.name = name;
  method.title = fmt::format("{} (verdicts from outside)", name);
  method.verdict = "as whoever made the file of verdicts means it";
  method.requirements.complete_record = false;
  method.locates_cvs = text.uses("cv");
  method.tells_sources = text.uses("source") || text.uses("cv_source");
  method.names_channels = text.uses("channels");
  method.names_mismatches = text.uses("parameter");
  method.origin = fmt::format("file of verdicts {}", file);
  return method;
}

/// The lines by the loop that they are of.
std::vector<const VerdictLine*> by_loop(const VerdictText& text, std::size_t loops) {
  std::vector<const VerdictLine*> lines(loops, nullptr);
  for (const VerdictLine& line : text.lines) {
    const std::string* const field = line.find("loop");
    const std::optional<std::size_t> loop = field ? number_in<std::size_t>(*field) : std::nullopt;
    if (!loop || *loop >= loops)
      throw InputError(fmt::format("{}: loop", line.place), fmt::format("'{}'", field ? *field : ""),
                       fmt::format("0 to {}", loops - 1));
    if (lines[*loop] != nullptr)
      throw InputError(fmt::format("{}: loop", line.place), fmt::format("{} twice", *loop), "each loop once");
    lines[*loop] = &line;
  }
  return lines;
}

}  // namespace

OutsideVerdicts read_verdicts(const std::filesystem::path& path, const std::string& name,
                              const Campaign& campaign) {
  require_name(name);
  const PlantModel& plant = campaign.study.plant;
  const VerdictText text = read_verdict_text(path, plant);
  if (const std::string hash = loops_hash(campaign); text.hash && *text.hash != hash)
    throw InputError(path.string(), fmt::format("verdicts on the loops {}", *text.hash),
                     fmt::format("verdicts on those of the archive, {}", hash));
  const MethodDescription method = description_of(text, name, path.filename().string());
  OutsideVerdicts verdicts{
      std::make_shared<const AssessmentForm>(method, campaign.study), {}, text.hash.has_value()};
  for (std::size_t i = 0; i < campaign.records.size(); ++i)
    verdicts.answers.push_back(unassessed({verdicts.form}).front());
  const std::vector<std::size_t> order = blind_order(campaign);
  const std::vector<const VerdictLine*> lines = by_loop(text, order.size());
  for (std::size_t loop = 0; loop < order.size(); ++loop)
    verdicts.answers[order[loop]] = kept(
        verdicts.form,
        lines[loop] == nullptr
            ? Assessment::failed("the file of verdicts has no line for this loop")
            : assessment_of(answer_json(*lines[loop], plant, method), plant, method, lines[loop]->place));
  return verdicts;
}

}  // namespace mpm
