#include "results/blind/verdict_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "analysis/findings/calibration.hpp"
#include "analysis/methods/method_file.hpp"
#include "analysis/methods/method_messages.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/source_probabilities.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "results/blind/blind_loops.hpp"
#include "results/files/csv_text.hpp"
#include "results/files/foreign_content.hpp"
#include "results/files/utf8.hpp"

namespace mpm {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLongestReason = 2000;  // bytes of an `error`

// How programs and spreadsheets of several languages write a flag. Capitals do not matter.
constexpr std::array kYes{"1", "true", "yes", "wahr", "vrai", "verdadero", "vero", "waar"};
constexpr std::array kNo{"0", "false", "no", "falsch", "faux", "falso", "onwaar"};

/// "p.mpm_ud"
std::string probability_column(std::string_view source) {
  return fmt::format("p.{}", source);
}

std::vector<std::string> known_columns(const PlantModel& plant) {
  std::vector<std::string> columns{"loop",   "window",    "flagged",   "score", "cv",
                                   "source", "channels",  "parameter", "size",  "lower",
                                   "upper",  "candidate", "error"};
  for (const char* of_cv : {"cv_flagged", "cv_score", "cv_source"})
    for (const PlantModel::Variable& cv : plant.cvs)
      columns.push_back(fmt::format("{}.{}", of_cv, cv.name));
  for (const std::string_view source : kWords<FaultSource>)
    columns.push_back(probability_column(source));
  return columns;
}

/// One line of the file: its non-empty fields by column.
struct VerdictLine {
  std::string place;           ///< "FILE:LINE"
  bool decimal_comma = false;  ///< numbers may have a decimal comma
  std::map<std::string, std::string> fields;

  const std::string* find(const std::string& column) const {
    const auto found = fields.find(column);
    return found == fields.end() ? nullptr : &found->second;
  }
  [[noreturn]] void refuse(const std::string& column, const std::string& allowed) const {
    throw InputError(fmt::format("{}: {}", place, column),
                     fmt::format("'{}'", cut_utf8(fields.at(column), kShownBytes)), allowed);
  }
};

struct VerdictText {
  std::optional<std::string> hash;
  std::vector<std::string> columns;
  std::vector<VerdictLine> lines;

  bool has(std::string_view column) const {
    return std::find(columns.begin(), columns.end(), column) != columns.end();
  }
  /// Tells whether any line has a value in a column whose name begins with `begin`.
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
      throw InputError(place, fmt::format("column '{}'", cut_utf8(column, kShownBytes)),
                       fmt::format("each once: {}", fmt::join(known, ", ")));
  text.columns = std::move(columns);
  if (!text.has("loop") || !text.has("flagged"))
    throw InputError(
        place, fmt::format("columns {}", cut_utf8(fmt::format("{}", fmt::join(text.columns, ",")), 200)),
        "at least loop and flagged in the heading line");
}

/// Returns the hash of the loops in a comment; a spreadsheet may have appended separators.
std::optional<std::string> hash_in(const std::string& comment) {
  const std::string line = hash_line("");
  const std::string begin = line.substr(0, line.find_last_not_of(" \n") + 1);
  if (!comment.starts_with(begin))
    return std::nullopt;
  const std::size_t first = comment.find_first_not_of(' ', begin.size());
  const std::size_t end = comment.find_first_not_of("0123456789abcdef", std::min(first, comment.size()));
  return comment.substr(std::min(first, comment.size()), end == std::string::npos ? end : end - first);
}

VerdictText read_verdict_text(const std::filesystem::path& path, const PlantModel& plant) {
  const std::string content = foreign_content(path, "a CSV file of verdicts");
  CsvReader reader(content, path.string(), {.comments_everywhere = true});
  std::vector<std::string> heading = reader.heading();
  if (heading.empty())
    throw InputError(path.string(), "no line", "a heading line and a line for each loop");
  VerdictText text;
  const bool numbered = heading.size() > 1 && heading.front().empty();  // the index of a pandas.DataFrame
  if (numbered)
    heading.erase(heading.begin());
  take_heading(text, std::move(heading), reader.place(), plant);
  for (std::vector<std::string> fields; reader.next(fields);) {
    VerdictLine verdict{reader.place(), reader.separator() != ',', {}};
    for (std::size_t i = 0; i < text.columns.size(); ++i)
      if (std::string& field = fields[numbered ? i + 1 : i]; !field.empty())
        verdict.fields.emplace(text.columns[i], std::move(field));
    text.lines.push_back(std::move(verdict));
  }
  for (const std::string& comment : reader.comments())
    if (auto hash = hash_in(comment))
      text.hash = std::move(hash);
  return text;
}

/// Reads a number, also one with a decimal comma if the file may have it.
std::optional<double> number_in(const VerdictLine& line, std::string text) {
  if (line.decimal_comma && std::count(text.begin(), text.end(), ',') == 1)
    std::replace(text.begin(), text.end(), ',', '.');
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

/// Reads a whole number from 0 on, also one with a decimal point: programs write columns with missing values
/// so.
std::optional<std::size_t> whole_number_in(const VerdictLine& line, const std::string& text) {
  constexpr double kLargest = 1e15;
  const std::optional<double> value = number_in(line, text);
  return value && *value >= 0.0 && *value <= kLargest && *value == std::floor(*value)
             ? std::optional(static_cast<std::size_t>(*value))
             : std::nullopt;
}

Json flag_json(const VerdictLine& line, const std::string& column) {
  const std::string* const field = line.find(column);
  if (field == nullptr)
    return nullptr;
  const std::string word = in_lower_case(*field);
  const std::optional<double> number = number_in(line, word);
  if (number == 1.0 || std::find(kYes.begin(), kYes.end(), word) != kYes.end())
    return true;
  if (number == 0.0 || std::find(kNo.begin(), kNo.end(), word) != kNo.end())
    return false;
  line.refuse(column, "1, 0, true, false, yes, no, or nothing for no verdict");
}

Json number_json(const VerdictLine& line, const std::string& column) {
  const std::string* const field = line.find(column);
  if (field == nullptr)
    return nullptr;
  const std::optional<double> value = number_in(line, *field);
  if (!value)
    line.refuse(column, "a number");
  if (std::isnan(*value))
    return nullptr;
  if (std::isinf(*value))
    return *value > 0 ? "Infinity" : "-Infinity";
  return *value;
}

Json text_json(const VerdictLine& line, const std::string& column) {
  const std::string* const field = line.find(column);
  return field == nullptr ? Json() : Json(*field);
}

/// Reads channels: "y1/u2 y3/u1".
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
  const std::optional<std::size_t> number = whole_number_in(line, *field);
  if (!number)
    line.refuse("candidate", "the number of a logged signal, from 1");
  return static_cast<std::int64_t>(*number);
}

/// Returns the answer that a method program would give in place of this line.
Json answer_json(const VerdictLine& line, const PlantModel& plant, const MethodDescription& method) {
  if (const std::string* const error = line.find("error"))
    return {{"error", cut_utf8(*error, kLongestReason)}};
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
  for (const std::string_view source : kWords<FaultSource>)
    if (const Json p = number_json(line, probability_column(source)); !p.is_null())
      answer["probabilities"][std::string(source)] = p;
  return answer;
}

void require_name(const std::string& name, const MethodTable& methods) {
  const std::vector<std::string> known = methods.names();
  if (!is_method_name(name) || std::find(known.begin(), known.end(), name) != known.end())
    throw InputError("--verdicts", fmt::format("the name '{}'", name),
                     fmt::format("NAME=FILE with {}, which no method of this program has", kMethodNameRule));
}

MethodDescription description_of(const VerdictText& text, const std::string& name, const std::string& file) {
  MethodDescription method;
  method.name = name;
  method.title = fmt::format("{} (verdicts from outside)", name);
  method.verdict = "as the author of the file of verdicts defines it";
  method.requirements.complete_record = false;
  method.tells_sources = text.uses("source") || text.uses("cv_source");
  method.locates_cvs = text.uses("cv") || method.tells_sources;
  method.names_channels = text.uses("channels");
  method.names_mismatches = text.uses("parameter");
  method.names_candidates = text.uses("candidate");
  if (text.uses("p."))
    method.numbers = source_probability_numbers();
  if (method.tells_sources)
    method.numbers.push_back(told_source_info());
  method.origin = fmt::format("file of verdicts {}", file);
  return method;
}

/// What a file says about one loop: a line on the whole loop, and lines on its windows; null: there is no
/// line.
struct LoopLines {
  const VerdictLine* whole = nullptr;
  std::vector<const VerdictLine*> windows = {};
};

/// Returns the number in a column; it must be below `count`, which must be above 0.
std::size_t place_in(const VerdictLine& line, const std::string& column, std::size_t count) {
  const std::string* const field = line.find(column);
  const std::optional<std::size_t> place = field ? whole_number_in(line, *field) : std::nullopt;
  if (!place || *place >= count)
    throw InputError(fmt::format("{}: {}", line.place, column),
                     fmt::format("'{}'", field ? cut_utf8(*field, kShownBytes) : ""),
                     fmt::format("0 to {}", count - 1));
  return *place;
}

/// Sorts the lines by the loops that they are about.
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

/// Reads the lines about one loop.
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

/// Tells whether the file is also about calibration loops. Refuses verdicts on the loops of another archive.
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
  require_name(name, method_table(campaign.study.assessment));
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
