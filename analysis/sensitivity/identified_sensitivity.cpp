#include "analysis/sensitivity/identified_sensitivity.hpp"

#include <fmt/format.h>

#include "analysis/identification/prediction_error_fit.hpp"
#include "analysis/statistics/signal_check.hpp"
#include "analysis/statistics/variance.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// Returns the row of a CV that does not move.
IdentifiedRow row_at_rest(Eigen::Index n_ref, Eigen::Index N) {
  IdentifiedRow row;
  row.validation_fit = kNaN;
  row.identification.status = IdentificationStatus::noise_free;
  row.identification.samples = N;
  row.identification.model.inputs.resize(static_cast<std::size_t>(n_ref));
  return row;
}

IdentifiedRow identified_row(const Eigen::VectorXd& y, const Eigen::Ref<const Eigen::MatrixXd>& r,
                             const std::vector<ModelOrder>& candidates,
                             const OrderSelectionOptions& options) {
  if (y.size() >= 2 && variance(y) <= variance_floor(y))
    return row_at_rest(r.rows(), y.size());
  const OrderSelection selection = select_order(y, r, candidates, options);
  IdentifiedRow row;
  if (!selection.best) {
    row.identification = selection.candidates.front().identification;
    row.validation_fit = kNaN;
    return row;
  }
  const OrderCandidate& best = selection.candidates[*selection.best];
  row.validation_fit = best.validation_fit;
  row.identification = identify(y, r, best.order, options.fit);
  // The search on the whole record may get lost from its starting point. The result is then the model of the
  // first part of the record.
  if (!is_usable(row.identification.status))
    row.identification = best.identification;
  return row;
}

}  // namespace

void IdentifiedSensitivityOptions::validate() const {
  if (samples < 1)
    throw InputError("samples of a step response", fmt::format("{}", samples), "1 or more");
  selection.validate();
}

IdentifiedSensitivity identified_sensitivity(const Eigen::Ref<const Eigen::MatrixXd>& r,
                                             const Eigen::Ref<const Eigen::MatrixXd>& y,
                                             const IdentifiedSensitivityOptions& options) {
  options.validate();
  if (r.rows() < 1 || y.rows() < 1)
    throw InputError("references and outputs", fmt::format("{} and {}", r.rows(), y.rows()),
                     "1 or more of each");
  if (r.cols() != y.cols())
    throw InputError("lengths of references and outputs", fmt::format("{} and {}", r.cols(), y.cols()),
                     "equal lengths");
  const std::vector<ModelOrder> candidates = order_candidates(options.orders, r.rows());
  IdentifiedSensitivity result;
  result.step_response.assign(static_cast<std::size_t>(r.rows()),
                              Eigen::MatrixXd::Constant(y.rows(), options.samples, kNaN));
  for (Eigen::Index cv = 0; cv < y.rows(); ++cv) {
    result.rows.push_back(identified_row(y.row(cv).transpose(), r, candidates, options.selection));
    const Identification& identification = result.rows.back().identification;
    if (!is_usable(identification.status))
      continue;
    const Eigen::MatrixXd response = step_response(identification.model, options.samples);
    for (Eigen::Index j = 0; j < r.rows(); ++j)
      result.step_response[static_cast<std::size_t>(j)].row(cv) = response.row(j);
  }
  return result;
}

}  // namespace mpm
