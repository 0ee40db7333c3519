#include "results/text/scenario_text.hpp"

#include <fmt/format.h>

#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

std::string cv_list(const Study& study, const std::vector<Eigen::Index>& cvs) {
  std::string text;
  for (const Eigen::Index cv : cvs)
    text += (text.empty() ? "" : ", ") + cv_name(study, cv);
  return text;
}

void add_source(std::string& text, const Study& study, Eigen::Index cv, FaultSource source) {
  text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", cv_name(study, cv), source_name(source));
}

}  // namespace

const std::string& scenario_name(const Study& study, const ExperimentRecord& record) {
  return study.scenarios[static_cast<std::size_t>(record.draw.index)].name;
}

std::string affected_text(const Study& study, const ExperimentDraw& draw) {
  std::string text;
  for (const AffectedCv& affected : draw.affected())
    add_source(text, study, affected.cv, affected.by);
  return text.empty() ? "none" : text;
}

std::string flagged_text(const Study& study, const AssessmentRecord& chain) {
  std::string text;
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
    if (chain.flags(cv))
      add_source(text, study, cv, chain.source_on(cv));
  return text.empty() ? "none" : text;
}

std::string scenario_verdict_text(const Study& study, const ExperimentRecord& record) {
  if (record.status != ExperimentStatus::ok)
    return std::string(to_string(record.status));
  const AssessmentRecord* const chain = record.diagnosed();
  if (chain == nullptr || !chain->answered())
    return "not assessed by the chain";
  const CvJudgement verdict = *judge(study, record, *chain).cvs;
  std::string text;
  const auto add = [&](const char* what, const std::vector<Eigen::Index>& cvs) {
    if (!cvs.empty())
      text += fmt::format("{}{} {}", text.empty() ? "" : "; ", what, cv_list(study, cvs));
  };
  add("missed", verdict.missed);
  add("false alarm", verdict.false_alarms);
  add("source of", verdict.wrong_source);
  return text.empty() ? "right" : text;
}

std::string acf_text(const AcfComparison& acf) {
  std::string text(to_string(acf.speed));
  if (acf.speed == LoopSpeed::slower || acf.speed == LoopSpeed::faster)
    text += " than designed";
  if (acf.oscillates_by_error())
    text += ", oscillates";
  if (acf.calmed_by_error())
    text += ", calmed";
  switch (acf.origin) {
    case ErrorOrigin::none:
      break;
    case ErrorOrigin::own:
      return text + "; own model";
    case ErrorOrigin::others:
      return text + "; models of other CVs";
    case ErrorOrigin::both:
      return text + "; own model and those of other CVs";
  }
  return text;
}

bool acf_differs(const AcfComparison& acf) {
  return acf.speed == LoopSpeed::slower || acf.speed == LoopSpeed::faster || acf.oscillates_by_error() ||
         acf.calmed_by_error();
}

}  // namespace mpm
