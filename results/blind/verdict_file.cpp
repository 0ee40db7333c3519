#include "results/blind/verdict_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "analysis/findings/calibration.hpp"
#include "analysis/methods/method_messages.hpp"
#include "analysis/methods/method_table.hpp"
#include "plants/error.hpp"
#include "plants/input_file.hpp"
#include "plants/non_finite.hpp"
#include "results/blind/blind_loops.hpp"

namespace mpm {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> known_columns(const PlantModel& plant) {
  std::vector<std::string> columns{"loop",   "window",    "flagged",   "score", "cv",
                                   "source", "channels",  "parameter", "size",  "lower",
                                   "upper",  "candidate", "error"};
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

Json candidate_json(const VerdictLine& line) {
  const std::string* const field = line.find("candidate");
  if (field == nullptr)
    return nullptr;
  const std::optional<std::int64_t> number = number_in<std::int64_t>(*field);
  if (!number)
    line.refuse("candidate", "the number of a logged signal, from 1");
  return *number;
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
  if (method.names_candidates)
    answer["candidate"] = candidate_json(line);
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
  method.tells_sources = text.uses("source") || text.uses("cv_source");
  method.locates_cvs = text.uses("cv") || method.tells_sources;
  method.names_channels = text.uses("channels");
  method.names_mismatches = text.uses("parameter");
  method.names_candidates = text.uses("candidate");
  method.origin = fmt::format("file of verdicts {}", file);
  return method;
}

/// What a file says of one loop: a line on it as a whole, and lines on its windows; null: none.
struct LoopLines {
  const VerdictLine* whole = nullptr;
  std::vector<const VerdictLine*> windows = {};
};

/// The number in a column, below `count`, which is above 0.
std::size_t place_in(const VerdictLine& line, const std::string& column, std::size_t count) {
  const std::string* const field = line.find(column);
  const std::optional<std::size_t> place = field ? number_in<std::size_t>(*field) : std::nullopt;
  if (!place || *place >= count)
    throw InputError(fmt::format("{}: {}", line.place, column), fmt::format("'{}'", field ? *field : ""),
                     fmt::format("0 to {}", count - 1));
  return *place;
}

/// The lines by the loop that they are of.
std::vector<LoopLines> by_loop(const VerdictText& text, std::size_t loops, std::size_t windows) {
  std::vector<LoopLines> lines(loops);
  for (const VerdictLine& line : text.lines) {
    const std::size_t loop = place_in(line, "loop", loops);
    const VerdictLine** place = &lines[loop].whole;
    if (line.find("window") != nullptr) {
      if (windows == 0)
        line.refuse("window", "nothing: the study does not monitor");
      lines[loop].windows.resize(windows, nullptr);
      place = &lines[loop].windows[place_in(line, "window", windows)];
    }
    if (*place != nullptr)
      throw InputError(fmt::format("{}: loop", line.place), fmt::format("{} twice", loop),
                       "each loop once, and each of its windows");
    *place = &line;
  }
  return lines;
}

/// Reads the lines on one loop.
class LoopVerdicts {
 public:
  LoopVerdicts(std::shared_ptr<const AssessmentForm> form, const PlantModel& plant, int candidates)
      : form_(std::move(form)), plant_(plant), candidates_(candidates) {}

  AssessmentRecord on(const LoopLines& lines) const {
    AssessmentRecord record =
        kept(form_, lines.whole ? said(*lines.whole)
                                : Assessment::failed("the file of verdicts has no line for this loop"));
    for (std::size_t window = 0; window < lines.windows.size(); ++window)
      if (const VerdictLine* const line = lines.windows[window])
        if (const Assessment of_window = said(*line); record.answered())
          add_window(record, static_cast<Eigen::Index>(window), of_window);
    return record;
  }

 private:
  Assessment said(const VerdictLine& line) const {
    Assessment assessment =
        assessment_of(answer_json(line, plant_, form_->method()), plant_, form_->method(), line.place);
    if (assessment.named_candidate && *assessment.named_candidate >= candidates_)
      line.refuse("candidate", candidates_ == 0 ? "nothing: the study logs no candidates"
                                                : fmt::format("1 to {}", candidates_));
    return assessment;
  }

  std::shared_ptr<const AssessmentForm> form_;
  const PlantModel& plant_;
  int candidates_;
};

/// Are calibration loops among those that the file is of? Refuses verdicts on the loops of another archive.
bool has_calibration(const VerdictText& text, const Campaign& campaign, const std::string& file) {
  if (!text.hash || *text.hash == loops_hash(campaign, false))
    return false;
  if (*text.hash != loops_hash(campaign, true))
    throw InputError(file, fmt::format("verdicts on the loops {}", *text.hash),
                     fmt::format("verdicts on those of the archive, {}, with calibration loops {}",
                                 loops_hash(campaign, false), loops_hash(campaign, true)));
  return true;
}

}  // namespace

OutsideVerdicts read_verdicts(const std::filesystem::path& path, const std::string& name,
                              const Campaign& campaign) {
  require_name(name);
  const Study& study = campaign.study;
  const VerdictText text = read_verdict_text(path, study.plant);
  const std::vector<BlindLoop> order = blind_order(campaign, has_calibration(text, campaign, path.string()));
  const auto windows =
      static_cast<std::size_t>(study.monitoring ? study.monitoring->count(study.simulation.samples) : 0);
  const std::vector<LoopLines> lines = by_loop(text, order.size(), windows);
  OutsideVerdicts verdicts{.form = std::make_shared<const AssessmentForm>(
                               description_of(text, name, path.filename().string()), study),
                           .answers = {},
                           .calibration_scores = std::vector<double>(campaign.calibration.loops.size(), kNaN),
                           .says_which_loops = text.hash.has_value()};
  verdicts.answers.assign(records_of(campaign).size(), unassessed({verdicts.form}).front());
  const LoopVerdicts reader(verdicts.form, study.plant, study.record.candidates);
  for (std::size_t loop = 0; loop < order.size(); ++loop) {
    AssessmentRecord answer = reader.on(lines[loop]);
    if (order[loop].of_calibration)
      verdicts.calibration_scores[order[loop].place] = calibration_score(answer);
    else
      verdicts.answers[order[loop].place] = std::move(answer);
  }
  return verdicts;
}

}  // namespace mpm
