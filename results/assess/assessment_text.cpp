#include <cmath>

#include <fmt/format.h>

#include "analysis/experiment/judgement.hpp"
#include "results/assess/record_assessment.hpp"
#include "results/text/experiment_text.hpp"
#include "results/text/text_table.hpp"

namespace mpm {
namespace {

std::string methods_table(const RecordAssessment& of) {
  TextTable table;
  table.add({"method", "flagged", "score", "CV", "source", "false alarms, %", "power, %"});
  for (std::size_t m = 0; m < of.said.size(); ++m) {
    const AssessmentRecord& said = of.said[m];
    const auto rate = [&](const Rate MethodRates::*which) {
      const Rate found = of.trial ? of.trial->methods[m].rates.*which : Rate{};
      return found.total == 0 ? std::string("-")
                              : fmt::format("{:.1f} [{:.1f}, {:.1f}]", 100.0 * found.value,
                                            100.0 * found.interval.lower, 100.0 * found.interval.upper);
    };
    if (said.answered())
      table.add({said.form->method().name, said.flagged ? "yes" : "no", fmt::format("{:.3g}", said.score),
                 said.flagged ? cv_name(of.study, said.predicted_cv) : "-",
                 said.flagged ? source_name(named_source(said)) : "-",
                 rate(&MethodRates::false_alarm_healthy), rate(&MethodRates::detected)});
    else
      table.add({said.form->method().name, std::string(to_string(said.status)), "-", "-", "-", "-", "-"});
  }
  return table.text();
}

std::string windows_table(const RecordAssessment& of) {
  const Eigen::MatrixXd flags = of.verdict().values("window_flagged");
  const Eigen::MatrixXd scores = of.verdict().values("window_score");
  if (flags.size() == 0)
    return "";
  TextTable table;
  table.add({"window", "flagged", "score"});
  for (int window = 0; window < flags.cols(); ++window)
    table.add({window_text(of, window),
               std::isnan(flags(0, window)) ? "no verdict"
               : flags(0, window) == 1.0    ? "yes"
                                            : "no",
               fmt::format("{:.3g}", scores(0, window))});
  return fmt::format("\n{}", table.text());
}

}  // namespace

std::string assessment_text(const RecordAssessment& assessment) {
  std::string text =
      fmt::format("{}: {} samples of {:g} {}, {} to {}\n\n", assessment.file, assessment.record.samples(),
                  assessment.study.controller.sample_time, assessment.study.plant.time_unit,
                  assessment.record.stamps.front(), assessment.record.stamps.back());
  for (const std::string& warning : assessment.warnings)
    text += fmt::format("warning: {}\n", warning);
  if (!assessment.warnings.empty())
    text += "\n";
  for (const std::string& sentence : verdict_sentences(assessment))
    text += fmt::format("{}\n", sentence);
  text += fmt::format("\n{}{}", methods_table(assessment), windows_table(assessment));
  for (const AssessmentRecord& said : assessment.said)
    if (!said.answered())
      text += fmt::format("{}: {}\n", said.form->method().name, said.reason);
  return text;
}

}  // namespace mpm
