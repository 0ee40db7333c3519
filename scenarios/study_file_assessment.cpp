#include <algorithm>

#include "scenarios/study_file_keys.hpp"
#include "scenarios/study_file_parts.hpp"
#include "scenarios/toml_values.hpp"

namespace mpm {
namespace {

constexpr std::int64_t kMaxOrder = 100;
constexpr std::int64_t kMaxLag = 1'000'000;

SunOptions read_sun(const TomlTable& assessment) {
  const TomlTable table = assessment.table_or_empty("sun", study_file_keys("assessment.sun"));
  SunOptions options;
  options.tolerance = read_number_or(table, "tolerance", NumberRule::positive(), options.tolerance);
  return options;
}

Badwe2009Options read_badwe2009(const TomlTable& assessment) {
  const TomlTable table = assessment.table_or_empty("badwe2009", study_file_keys("assessment.badwe2009"));
  Badwe2009Options options;
  options.confidence = read_number_or(table, "confidence", NumberRule::inside(0, 1), options.confidence);
  return options;
}

Badwe2010Options read_badwe2010(const TomlTable& assessment) {
  const TomlTable table = assessment.table_or_empty("badwe2010", study_file_keys("assessment.badwe2010"));
  Badwe2010Options options;
  options.smallest_order =
      static_cast<int>(read_whole_or(table, "smallest_order", 1, kMaxOrder, options.smallest_order));
  options.largest_order =
      static_cast<int>(read_whole_or(table, "largest_order", options.smallest_order, kMaxOrder,
                                     std::max(options.smallest_order, options.largest_order)));
  return options;
}

YuQinOptions read_yu_qin(const TomlTable& assessment) {
  const TomlTable table = assessment.table_or_empty("yu-qin", study_file_keys("assessment.yu-qin"));
  YuQinOptions options;
  options.confidence = read_number_or(table, "confidence", NumberRule::inside(0, 1), options.confidence);
  options.largest_lag =
      static_cast<int>(read_whole_or(table, "largest_lag", 0, kMaxLag, options.largest_lag));
  options.first_sample =
      static_cast<int>(read_whole_or(table, "first_sample", 0, kMaxLag, options.first_sample));
  return options;
}

SseOptions read_sse(const TomlTable& assessment) {
  const TomlTable table = assessment.table_or_empty("sse", study_file_keys("assessment.sse"));
  SseOptions options;
  options.threshold = read_number_or(table, "threshold", NumberRule::positive(), options.threshold);
  return options;
}

}  // namespace

AssessmentOptions read_assessment(const TomlTable& document) {
  const TomlTable table = document.table_or_empty("assessment", study_file_keys("assessment"));
  AssessmentOptions options;
  options.setpoints = read_choice_or<AssessmentSetpoints>(
      table, "setpoints",
      {{"controller", AssessmentSetpoints::controller}, {"optimizer", AssessmentSetpoints::optimizer}},
      options.setpoints);
  options.sun = read_sun(table);
  options.badwe2009 = read_badwe2009(table);
  options.badwe2010 = read_badwe2010(table);
  options.yu_qin = read_yu_qin(table);
  options.sse = read_sse(table);
  return options;
}

}  // namespace mpm
