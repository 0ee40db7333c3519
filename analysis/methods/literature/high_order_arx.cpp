#include "analysis/methods/literature/high_order_arx.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "analysis/identification/nested_least_squares.hpp"
#include "analysis/statistics/best_candidate.hpp"
#include "analysis/statistics/signal_check.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

using Matrix = Eigen::Ref<const Eigen::MatrixXd>;

/// Regressors in an order in which the first columns are those of a lower order: constant, terms of a fixed
/// MO2, then lag by lag.
class LagRegressors {
 public:
  /// `outputs` are the rows of y that explain the CV.
  LagRegressors(const Matrix& outputs, const Matrix& r, const HighOrderArxOptions& options)
      : constant_(options.constant ? 1 : 0),
        fixed_(options.input_order.value_or(0) * r.rows()),
        per_lag_(outputs.rows() + (options.input_order ? 0 : r.rows())) {
    const Eigen::Index highest = *std::max_element(options.orders.begin(), options.orders.end());
    const Eigen::Index first = std::max(highest, options.input_order.value_or(0));
    columns_.resize(outputs.cols() - first, columns(highest));
    columns_.leftCols(constant_).setOnes();
    next_ = constant_;
    if (options.input_order)
      for (Eigen::Index lag = 1; lag <= *options.input_order; ++lag)
        append(r, first - lag);
    for (Eigen::Index lag = 1; lag <= highest; ++lag) {
      append(outputs, first - lag);
      if (!options.input_order)
        append(r, first - lag);
    }
  }

  const Eigen::MatrixXd& matrix() const { return columns_; }
  Eigen::Index columns(Eigen::Index order) const { return constant_ + fixed_ + order * per_lag_; }

 private:
  void append(const Matrix& signals, Eigen::Index begin) {
    columns_.middleCols(next_, signals.rows()) = signals.middleCols(begin, columns_.rows()).transpose();
    next_ += signals.rows();
  }

  Eigen::Index constant_, fixed_, per_lag_;
  Eigen::MatrixXd columns_;
  Eigen::Index next_ = 0;
};

Eigen::Index first_sample_of(const HighOrderArxOptions& options) {
  return std::max(*std::max_element(options.orders.begin(), options.orders.end()),
                  options.input_order.value_or(0));
}

void require_record(const Matrix& y, const Matrix& r, const HighOrderArxOptions& options) {
  if (y.rows() < 1)
    throw InputError("outputs of a high-order ARX model", "none", "1 or more");
  if (r.rows() > 0 && r.cols() != y.cols())
    throw InputError("lengths of outputs and references", fmt::format("{} and {}", y.cols(), r.cols()),
                     "equal lengths");
  if (const Eigen::Index fewest = fewest_samples(options, y.rows(), r.rows()); y.cols() < fewest)
    throw InputError("samples of a high-order ARX model", fmt::format("{}", y.cols()),
                     fmt::format("{} or more, or lower orders, or the past of the CV alone", fewest));
  for (Eigen::Index i = 0; i < y.rows(); ++i)
    require_signal(fmt::format("output {}", i), y.row(i).transpose(), 1);
  if (!r.allFinite())
    throw InputError("references", "a value that is not finite", "finite values only");
}

/// A score of each candidate order; smaller is better.
std::vector<double> scores(const LagRegressors& regressors, const Eigen::MatrixXd& targets, Eigen::Index side,
                           const NestedLeastSquares& fit, const HighOrderArxOptions& options) {
  const auto n = static_cast<double>(targets.rows());
  const double weight = options.criterion == OrderCriterion::bic ? std::log(n) : 2.0;
  std::vector<double> result;
  for (const Eigen::Index order : options.orders) {
    const Eigen::Index columns = regressors.columns(order);
    result.push_back(n * std::log(fit.residual_sum(columns, side) / n) +
                     weight * static_cast<double>(fit.rank(columns)));
  }
  return result;
}

/// The mean square errors at the end of the record of models that are fitted to its beginning.
std::vector<double> validation_losses(const LagRegressors& regressors, const Eigen::MatrixXd& targets,
                                      Eigen::Index side, const NestedLeastSquares& beginning,
                                      Eigen::Index validation, const HighOrderArxOptions& options) {
  std::vector<double> result;
  for (const Eigen::Index order : options.orders) {
    const Eigen::Index columns = regressors.columns(order);
    const Eigen::VectorXd e =
        targets.col(side).tail(validation) -
        regressors.matrix().bottomLeftCorner(validation, columns) * beginning.solution(columns, side);
    result.push_back(e.squaredNorm() / static_cast<double>(validation));
  }
  return result;
}

/// Fills in the results of the CVs `cvs`, which share their regressors.
void fit_cvs(const std::vector<Eigen::Index>& cvs, const LagRegressors& regressors, const Matrix& y,
             const HighOrderArxOptions& options, HighOrderArx& result) {
  const Eigen::MatrixXd& A = regressors.matrix();
  const Eigen::Index n = A.rows();
  Eigen::MatrixXd targets(n, static_cast<Eigen::Index>(cvs.size()));
  for (std::size_t c = 0; c < cvs.size(); ++c)
    targets.col(static_cast<Eigen::Index>(c)) = y.row(cvs[c]).tail(n).transpose();
  const NestedLeastSquares fit(A, targets, options.rank_tolerance);
  std::optional<NestedLeastSquares> beginning;
  const auto estimation =
      static_cast<Eigen::Index>(std::floor(static_cast<double>(n) * (1.0 - options.validation_share)));
  if (options.orders.size() > 1 && options.criterion == OrderCriterion::validation_loss)
    beginning.emplace(A.topRows(estimation), targets.topRows(estimation), options.rank_tolerance);
  for (std::size_t c = 0; c < cvs.size(); ++c) {
    const auto side = static_cast<Eigen::Index>(c);
    const std::vector<double> score =
        beginning ? validation_losses(regressors, targets, side, *beginning, n - estimation, options)
                  : scores(regressors, targets, side, fit, options);
    const auto best =
        required_best_candidate("criteria of high-order ARX models", score, std::negate<>()) - score.begin();
    const Eigen::Index order = options.orders[static_cast<std::size_t>(best)];
    const Eigen::Index columns = regressors.columns(order);
    result.orders[static_cast<std::size_t>(cvs[c])] = order;
    result.parameters[static_cast<std::size_t>(cvs[c])] = fit.rank(columns);
    result.e_d.row(cvs[c]) =
        (targets.col(side) - A.leftCols(columns) * fit.solution(columns, side)).transpose();
  }
}

}  // namespace

void HighOrderArxOptions::validate() const {
  if (orders.empty())
    throw InputError("orders of a high-order ARX model", "none", "1 or more");
  for (const Eigen::Index order : orders)
    if (order < 1)
      throw InputError("order of a high-order ARX model", fmt::format("{}", order), "1 or more");
  if (input_order && *input_order < 1)
    throw InputError("order of the references of a high-order ARX model", fmt::format("{}", *input_order),
                     "1 or more");
  if (criterion == OrderCriterion::validation_fit)
    throw InputError("criterion of the order of a high-order ARX model", "validation_fit",
                     "validation_loss, aic or bic");
  if (!(validation_share > 0.0 && validation_share < 1.0))
    throw InputError("validation share", fmt::format("{}", validation_share), "above 0 and below 1");
  if (!(rank_tolerance > 0.0 && rank_tolerance < 1.0))
    throw InputError("rank tolerance", fmt::format("{}", rank_tolerance), "above 0 and below 1");
}

Eigen::Index fewest_samples(const HighOrderArxOptions& options, Eigen::Index ny, Eigen::Index nr) {
  const Eigen::Index highest = *std::max_element(options.orders.begin(), options.orders.end());
  const Eigen::Index outputs = options.outputs == ArxOutputs::all ? ny : 1;
  const Eigen::Index parameters =
      (options.constant ? 1 : 0) + outputs * highest + nr * options.input_order.value_or(highest);
  Eigen::Index fitted = parameters + 1;
  if (options.orders.size() > 1 && options.criterion == OrderCriterion::validation_loss)
    fitted =
        static_cast<Eigen::Index>(std::ceil(static_cast<double>(fitted) / (1.0 - options.validation_share)));
  return first_sample_of(options) + fitted;
}

HighOrderArx identify_high_order_arx(const Matrix& y, const Matrix& r, const HighOrderArxOptions& options) {
  options.validate();
  require_record(y, r, options);
  const auto ny = static_cast<std::size_t>(y.rows());
  HighOrderArx result;
  result.first_sample = first_sample_of(options);
  result.e_d.resize(y.rows(), y.cols() - result.first_sample);
  result.orders.resize(ny);
  result.parameters.resize(ny);
  std::vector<Eigen::Index> cvs(ny);
  for (std::size_t i = 0; i < ny; ++i)
    cvs[i] = static_cast<Eigen::Index>(i);
  if (options.outputs == ArxOutputs::all)
    fit_cvs(cvs, LagRegressors(y, r, options), y, options, result);
  else
    for (const Eigen::Index i : cvs)
      fit_cvs({i}, LagRegressors(y.row(i), r, options), y, options, result);
  return result;
}

}  // namespace mpm
