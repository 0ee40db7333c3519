#include "analysis/methods/literature/badwe2009.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {
namespace {

std::vector<Eigen::Index> evaluated(const std::vector<MvUse>& uses) {
  std::vector<Eigen::Index> mvs;
  for (std::size_t i = 0; i < uses.size(); ++i)
    if (uses[i] == MvUse::evaluated)
      mvs.push_back(static_cast<Eigen::Index>(i));
  return mvs;
}

std::vector<Eigen::Index> without(const std::vector<Eigen::Index>& mvs, Eigen::Index mv) {
  std::vector<Eigen::Index> others = mvs;
  others.erase(std::remove(others.begin(), others.end(), mv), others.end());
  return others;
}

/// The confidence at which each correlation is tested.
double single_confidence(const Badwe2009Options& options, std::size_t channels) {
  double tests = 1.0;
  if (options.multiplicity != Multiplicity::none)
    tests *= static_cast<double>(options.max_lag - options.min_lag + 1);
  if (options.multiplicity == Multiplicity::channels)
    tests *= static_cast<double>(channels);
  return 1.0 - (1.0 - options.confidence) / tests;
}

/// If there are fewer signals from outside than MVs, the parts of the MVs that they drive are linearly
/// dependent.
NoiseFilter filter_of(const Badwe2009Record& record, const Badwe2009Options& options, std::size_t mvs) {
  if (options.filter != NoiseFilter::automatic)
    return options.filter;
  const auto signals = static_cast<std::size_t>(moving_rows(record.external).rows());
  return signals > 0 && signals >= mvs ? NoiseFilter::external : NoiseFilter::none;
}

double mean_square(const Eigen::MatrixXd& row) {
  return (row.array() - row.mean()).square().mean();
}

/// Finds the correlations of one MV with all prediction errors, from signals without noise.
class MvAssessment {
 public:
  MvAssessment(const Eigen::MatrixXd& e, const Eigen::MatrixXd& u, const Badwe2009Options& options,
               Badwe2009Result& result)
      : e_(e), u_(u), options_(options), result_(result), mvs_(evaluated(result.mv_use)) {}

  void assess_all() {
    const double confidence = single_confidence(options_, mvs_.size() * static_cast<std::size_t>(e_.rows()));
    for (const Eigen::Index mv : mvs_)
      assess(mv, confidence);
  }

 private:
  void assess(Eigen::Index mv, double confidence) {
    const Eigen::MatrixXd others = u_(without(mvs_, mv), Eigen::all);
    const Decorrelator decorrelator(others, options_.models);
    const Decorrelation own = decorrelator.decorrelate(u_.row(mv), 0);
    result_.unusable += own.unusable;
    if (mean_square(own.residuals) < options_.smallest_own_share * mean_square(u_.row(mv))) {
      result_.mv_use[static_cast<std::size_t>(mv)] = MvUse::dependent;
      return;
    }
    const Decorrelation errors = decorrelator.decorrelate(e_, 1);
    result_.unusable += errors.unusable;
    for (Eigen::Index cv = 0; cv < e_.rows(); ++cv) {
      ChannelAssessment& channel = result_.channels[static_cast<std::size_t>(cv * u_.rows() + mv)];
      channel.correlation =
          partial_correlation(own.residuals.row(0).transpose(), errors.residuals.row(cv).transpose(),
                              options_.min_lag, options_.max_lag, confidence, errors.parameters);
      channel.mismatch = channel.correlation.is_strong(options_.weakest_correlation);
    }
  }

  const Eigen::MatrixXd& e_;
  const Eigen::MatrixXd& u_;
  const Badwe2009Options& options_;
  Badwe2009Result& result_;
  std::vector<Eigen::Index> mvs_;
};

std::string shape(const Eigen::MatrixXd& signals) {
  return fmt::format("{} x {}", signals.rows(), signals.cols());
}

}  // namespace

void Badwe2009Record::validate() const {
  if (y.size() == 0 || u.size() == 0)
    throw InputError("record for partial correlations", fmt::format("y {}, u {}", shape(y), shape(u)),
                     "samples of a CV and an MV or more");
  if (y_sim.rows() != y.rows() || y_sim.cols() != y.cols() || u.cols() != y.cols() ||
      (external.size() > 0 && external.cols() != y.cols()))
    throw InputError(
        "record for partial correlations",
        fmt::format("y {}, y_sim {}, u {}, external {}", shape(y), shape(y_sim), shape(u), shape(external)),
        "y_sim of the shape of y, and the same number of samples");
  if (!y.allFinite() || !y_sim.allFinite() || !u.allFinite() || !external.allFinite())
    throw InputError("record for partial correlations", "a value that is not finite", "finite values only");
}

const ChannelAssessment& Badwe2009Result::channel(Eigen::Index cv, Eigen::Index mv) const {
  return channels[static_cast<std::size_t>(cv) * mv_use.size() + static_cast<std::size_t>(mv)];
}

Badwe2009Result assess_badwe2009(const Badwe2009Record& record, const Badwe2009Options& options) {
  record.validate();
  Badwe2009Result result;
  result.channels.resize(static_cast<std::size_t>(record.y.rows() * record.u.rows()));
  result.mv_use = mv_uses(record.u, record.limits, options.saturated_share, options.smallest_deviation);

  result.filter = filter_of(record, options, evaluated(result.mv_use).size());

  Eigen::MatrixXd u = noise_filtered(record.u, result.filter, options.filter_length);
  const Eigen::MatrixXd e = noise_filtered(record.y_sim - record.y, result.filter, options.filter_length);
  if (result.filter == NoiseFilter::external) {
    u = externally_driven(record.u, record.external, options.models);
    const std::vector<MvUse> driven = mv_uses(u, record.limits, 1.0, options.smallest_deviation);
    for (std::size_t i = 0; i < driven.size(); ++i)
      if (result.mv_use[i] == MvUse::evaluated)
        result.mv_use[i] = driven[i];
  }
  MvAssessment(e, u, options, result).assess_all();
  if (evaluated(result.mv_use).empty())
    result.status = Badwe2009Status::no_mv;
  return result;
}

}  // namespace mpm
