#include "results/experiment_text.hpp"

#include <fmt/format.h>

#include "results/variable_text.hpp"

namespace mpm {
namespace {

std::string mismatch_text(const Study& study, const Mismatch& mismatch) {
  const std::string channel = fmt::format("{}/{}", cv_name(study, mismatch.cv),
                                          study.plant.mvs[static_cast<std::size_t>(mismatch.mv)].name);
  switch (mismatch.parameter) {
    case MismatchParameter::gain:
      return fmt::format("gain of {} x {:.3g}", channel, mismatch.value);
    case MismatchParameter::time_constant:
      return fmt::format("time constant of {} x {:.3g}", channel, mismatch.value);
    case MismatchParameter::dead_time:
      return fmt::format("dead time of {} {:+.3g} {}", channel, mismatch.value,
                         unit_text(study.plant.time_unit));
  }
  return "unknown";
}

}  // namespace

std::string kind_name(ExperimentKind kind) {
  switch (kind) {
    case ExperimentKind::none:
      return "none";
    case ExperimentKind::mpm:
      return "MPM";
    case ExperimentKind::ud:
      return "UD";
    case ExperimentKind::mpm_ud:
      return "MPM+UD";
  }
  return "unknown";
}

std::string cv_name(const Study& study, Eigen::Index cv) {
  return cv < 0 ? "none" : study.plant.cvs[static_cast<std::size_t>(cv)].name;
}

std::string fault_text(const Study& study, const ExperimentDraw& draw) {
  std::string text;
  if (draw.mismatch)
    text = mismatch_text(study, *draw.mismatch);
  if (draw.disturbance)
    text += fmt::format("{}disturbance on {}: gain {:.3g}, time constant {:.3g} {}", text.empty() ? "" : "; ",
                        cv_name(study, draw.disturbance->cv), draw.disturbance->gain,
                        draw.disturbance->time_constant, unit_text(study.plant.time_unit));
  return text.empty() ? "nothing" : text;
}

std::string experiment_title(const Study& study, const ExperimentDraw& draw) {
  return fmt::format("experiment {} ({}): {}", draw.index, kind_name(draw.kind), fault_text(study, draw));
}

std::string verdict_text(const Study& study, const ExperimentRecord& record) {
  if (record.status != ExperimentStatus::ok)
    return std::string(to_string(record.status));
  const Diagnosis& verdict = record.diagnosis;
  return fmt::format("{}located {}, I_MPM {:.3f}: {}", verdict.impactful ? "" : "no impact, ",
                     cv_name(study, verdict.predicted_cv), verdict.indicator.i_mpm,
                     kind_name(verdict.predicted_source));
}

std::string experiment_line(const Study& study, const ExperimentRecord& record) {
  return experiment_title(study, record.draw) + "; " + verdict_text(study, record);
}

}  // namespace mpm
