#include "analysis/methods/assessment_method.hpp"

#include <cassert>

#include "plants/error.hpp"

namespace mpm {
namespace {

/// Some row of the record changes.
bool moves(const Eigen::MatrixXd& record) {
  return record.cols() > 0 && (record.colwise() - record.col(0)).cwiseAbs().maxCoeff() > 0.0;
}

bool some_setpoint_moves(const AssessedLoop& loop) {
  for (const Eigen::Index cv : loop.setpoint_cvs())
    if (moves(loop.y_set.row(cv)))
      return true;
  return false;
}

}  // namespace

std::optional<std::string> unmet_requirement(const AssessmentRequirements& requirements,
                                             const AssessmentContext& context, const AssessedLoop& loop) {
  const bool needs_setpoints = requirements.setpoints || requirements.moving_setpoints;
  if (needs_setpoints && loop.setpoint_cvs().empty())
    return "it needs setpoints, and the controller holds every CV in a range";
  if (requirements.moving_setpoints && !some_setpoint_moves(loop))
    return "it needs setpoints that move, and none does";
  if (requirements.benchmark && !context.benchmark)
    return "it needs a benchmark period, and none is known";
  if (requirements.moving_mvs && !moves(loop.u))
    return "it needs MVs that move, and none does";
  return std::nullopt;
}

Assessor::Assessor(const AssessmentMethodInfo& info, const AssessmentContext& context)
    : requirements_(info.requirements), context_(context), make_(info.make) {}

Assessment Assessor::assess(const AssessedLoop& loop) {
  if (const std::optional<std::string> unmet = unmet_requirement(requirements_, context_, loop))
    return Assessment::not_applicable(*unmet);
  if (!method_)
    method_ = make_(context_);
  try {
    Assessment assessment = method_->assess(loop);
    assert(assessment.cvs.empty() || static_cast<Eigen::Index>(assessment.cvs.size()) == loop.y.rows());
    return assessment;
  } catch (const InputError& error) {
    return Assessment::failed(error.what());
  }
}

}  // namespace mpm
