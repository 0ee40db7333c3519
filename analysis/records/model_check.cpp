#include "analysis/records/model_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <fmt/format.h>

#include "analysis/records/untold_part.hpp"
#include "analysis/sensitivity/nominal_output.hpp"
#include "analysis/statistics/signal_check.hpp"
#include "plants/error.hpp"
#include "scenarios/faults/fault.hpp"

namespace mpm {
namespace {

constexpr double kFarTooLarge = 1.5;  ///< a score that is flagged without simulated records
constexpr double kUsual = 2.0;        ///< the largest of some errors of the model, standard deviations
constexpr double kStep = 0.01;        ///< relative, of differences that stand for derivatives

/// y_ij(a): what input j does to each CV, from where it begins.
Eigen::MatrixXd response(const TransferMatrix& G, double sample_time, Eigen::Index input,
                         const Eigen::RowVectorXd& signal) {
  TransferMatrix column(G.rows(), 1);
  for (Eigen::Index cv = 0; cv < G.rows(); ++cv)
    column(cv, 0) = G(cv, input);
  return simulated_output(column, sample_time, Eigen::VectorXd::Zero(1),
                          (signal.array() - signal(0)).matrix(), Eigen::MatrixXd(0, signal.size()));
}

/// The errors of a CV that are there, in the order of time, and the mean squared difference of those that
/// follow each other.
struct Errors {
  std::vector<Eigen::Index> samples;
  Eigen::VectorXd e;
  double noise = 0.0;  ///< v_i

  Errors(const Eigen::RowVectorXd& y, const Eigen::RowVectorXd& y_sim) {
    double squares = 0.0, pairs = 0.0;
    for (Eigen::Index k = 0; k < y.size(); ++k)
      if (!std::isnan(y(k) - y_sim(k)))
        samples.push_back(k);
    e.resize(std::ssize(samples));
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      e(at) = y(samples[i]) - y_sim(samples[i]);
      if (i > 0 && samples[i] == samples[i - 1] + 1) {
        squares += (e(at) - e(at - 1)) * (e(at) - e(at - 1));
        pairs += 1.0;
      }
    }
    if (pairs == 0.0)
      throw InputError("record of a CV", "no two samples in a row", "some");
    noise = 0.5 * squares / pairs + variance_floor(y_sim.transpose());
  }
};

class ModelCheck final : public AssessmentMethod {
 public:
  ModelCheck(const AssessmentContext& context, double delta)
      : study_(context.study), delta_(delta), slower_(study_.plant.G), later_(study_.plant.G) {
    const TransferMatrix& G = study_.plant.G;
    std::vector<Mismatch> times, dead_times;
    for (Eigen::Index cv = 0; cv < G.rows(); ++cv)
      for (Eigen::Index input = 0; input < G.cols(); ++input) {
        if (G(cv, input).is_zero())
          continue;
        times.push_back({cv, input, MismatchParameter::time_constant, 1.0 + kStep});
        if (G(cv, input).dead_time() > 0.0)
          dead_times.push_back({cv, input, MismatchParameter::dead_time, kStep * G(cv, input).dead_time()});
      }
    slower_ = with_mismatches(G, times);
    later_ = with_mismatches(G, dead_times);
  }

  Assessment assess(const AssessedLoop& loop) override {
    const AssessedLoop& whole = loop.from_start();
    const std::vector<Eigen::MatrixXd> S = responses(whole);
    const std::vector<Eigen::Index> starts = starts_after_unknown(loop.y, slowest_settling(study_));
    Assessment assessment;
    assessment.score = 0.0;
    for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv) {
      const double score = score_of(Errors(loop.y.row(cv), loop.y_sim.row(cv)), S,
                                    untold_columns(study_, cv, starts, loop.samples()), cv, loop.first);
      assessment.cvs.push_back({score > kFarTooLarge, score});
      assessment.score = std::max(assessment.score, score);
    }
    assessment.flagged = assessment.score > kFarTooLarge;
    return assessment;
  }

 private:
  /// The columns of S, each for all CVs.
  std::vector<Eigen::MatrixXd> responses(const AssessedLoop& loop) const {
    const TransferMatrix& G = study_.plant.G;
    const double Ts = study_.controller.sample_time;
    std::vector<Eigen::MatrixXd> S;
    for (Eigen::Index input = 0; delta_ > 0.0 && input < G.cols(); ++input) {
      const Eigen::RowVectorXd signal =
          input < loop.u.rows() ? loop.u.row(input) : loop.d.row(input - loop.u.rows());
      const std::size_t gain = S.size();
      S.push_back(response(G, Ts, input, signal));
      for (const TransferMatrix* const other : {&slower_, &later_}) {
        Eigen::MatrixXd slope = (response(*other, Ts, input, signal) - S[gain]) / kStep;
        S.push_back(std::move(slope));
      }
    }
    return S;
  }

  double score_of(const Errors& errors, const std::vector<Eigen::MatrixXd>& S, const Eigen::MatrixXd& untold,
                  Eigen::Index cv, Eigen::Index first) const {
    const Eigen::Index n = errors.e.size();
    Eigen::MatrixXd X(n, std::ssize(S));
    for (Eigen::Index k = 0; k < n; ++k)
      for (Eigen::Index column = 0; column < X.cols(); ++column)
        X(k, column) = delta_ * S[static_cast<std::size_t>(column)](
                                    cv, first + errors.samples[static_cast<std::size_t>(k)]);
    // y_sim has what nobody can tell, so that the columns must not.
    const Eigen::MatrixXd U = untold(errors.samples, Eigen::all);
    if (n > U.cols())
      X -= U * U.completeOrthogonalDecomposition().solve(X);
    // The noise of errors that no channel explains is larger than that of their differences.
    double noise = errors.noise;
    Eigen::VectorXd a = Eigen::VectorXd::Zero(X.cols());
    double squares = errors.e.squaredNorm() / static_cast<double>(n);
    for (int pass = 0; pass < 2 && X.cols() > 0; ++pass) {
      Eigen::MatrixXd A = X.transpose() * X / noise;
      A.diagonal().array() += 1.0;
      a = A.ldlt().solve(X.transpose() * errors.e / noise);
      squares = (errors.e - X * a).squaredNorm() / static_cast<double>(n);
      noise = std::max(errors.noise, squares);
    }
    const double off = a.size() > 0 ? a.cwiseAbs().maxCoeff() / kUsual : 0.0;
    return std::max(off, std::sqrt(squares / errors.noise));
  }

  const Study& study_;
  double delta_;
  TransferMatrix slower_, later_;  ///< every time constant, or dead time, longer by kStep
};

}  // namespace

AssessmentMethodInfo model_check_method(double delta) {
  return {
      {.name = kModelCheck,
       .title = "errors of the model",
       .verdict = "the simulation errors of some CV are larger than noise and errors of the model of some "
                  "percent make them",
       .requirements = {.complete_record = false},
       .locates_cvs = true,
       .numbers = {},
       .origin = "mpmbench assess",
       .fingerprint = fmt::format("{:g}", delta)},
      {},
      [delta](const AssessmentContext& context) { return std::make_unique<ModelCheck>(context, delta); }};
}

}  // namespace mpm
