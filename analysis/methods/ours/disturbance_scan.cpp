#include "analysis/methods/ours/disturbance_scan.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/statistics/best_candidate.hpp"
#include "analysis/statistics/truncated_normal.hpp"

namespace mpm {
namespace {

constexpr Eigen::Index kPoints = 9;  // sizes that are tried at once for a time constant
constexpr int kMostStages = 6;
constexpr double kFineEnough = 1.0;  // drop of log L from the best size to its neighbours
constexpr double kOutside = 14.0;    // sizes whose log L is lower by this are outside of the finer grid
constexpr double kNegligible = 15.0;
/// A time constant is dropped if its log L is so far below the best. The margin is larger while the sizes are
/// coarse, since log L still grows then.
constexpr double kHopeless = 14.0, kStillCoarse = 25.0;

/// The sizes of one time constant.
struct SizeGrid {
  double low, high;  ///< of log(size)
  Eigen::ArrayXd log_likelihood = Eigen::ArrayXd(kPoints);
  bool done = false, dropped = false;

  double spacing() const { return (high - low) / static_cast<double>(kPoints - 1); }
  double log_size(Eigen::Index i) const { return low + static_cast<double>(i) * spacing(); }

  /// Makes the grid finer where the likelihood is, unless it is fine enough.
  void refine() {
    Eigen::Index best = 0;
    const double largest = log_likelihood.maxCoeff(&best);
    const Eigen::Index left = std::max<Eigen::Index>(best - 1, 0);
    const Eigen::Index right = std::min<Eigen::Index>(best + 1, kPoints - 1);
    if (largest - std::min(log_likelihood(left), log_likelihood(right)) <= kFineEnough) {
      done = true;
      return;
    }
    Eigen::Index first = left, last = right;
    while (first > 0 && log_likelihood(first) > largest - kOutside)
      --first;
    while (last < kPoints - 1 && log_likelihood(last) > largest - kOutside)
      ++last;
    const double new_low = log_size(first), new_high = log_size(last);
    if (first == 0 && last == kPoints - 1) {
      done = true;  // broad, with an edge somewhere
      return;
    }
    low = new_low;
    high = new_high;
  }
};

class DisturbanceScan {
 public:
  DisturbanceScan(const std::vector<DisturbancePrior>& prior, const BaseNoise& base, bool starts_from_rest,
                  const ScaleLikelihood& likelihood, const Eigen::Ref<const Eigen::MatrixXd>& series)
      : prior_(prior), base_(base), rest_(starts_from_rest), likelihood_(likelihood), series_(series) {
    for (const DisturbancePrior& each : prior) {
      const auto [low, high] = support(each.size);
      grids_.push_back({std::log(low), std::log(high)});
    }
  }

  WeighedModels run() {
    for (int stage = 0; stage < kMostStages; ++stage) {
      if (!evaluate())
        break;
      drop_hopeless(stage == 0 ? kStillCoarse : kHopeless);
      if (stage + 1 < kMostStages)
        for (SizeGrid& grid : grids_)
          if (!grid.done && !grid.dropped)
            grid.refine();
    }
    return collected();
  }

 private:
  double innovation_deviation(std::size_t t, Eigen::Index i) const {
    return std::hypot(prior_[t].scale * std::exp(grids_[t].log_size(i)) / base_.deviation, base_.b);
  }

  NoiseModels models(const std::vector<std::size_t>& places) const {
    const auto count = static_cast<Eigen::Index>(places.size()) * kPoints;
    NoiseModels models{Eigen::ArrayXd(count), Eigen::ArrayXd(count), base_.phi, rest_};
    Eigen::Index node = 0;
    for (const std::size_t t : places)
      for (Eigen::Index i = 0; i < kPoints; ++i, ++node) {
        models.a(node) = prior_[t].a;
        models.b(node) = innovation_deviation(t, i);
      }
    return models;
  }

  /// Computes the likelihoods of all open grids; returns whether there were any.
  bool evaluate() {
    std::vector<std::size_t> open;
    for (std::size_t t = 0; t < grids_.size(); ++t)
      if (!grids_[t].done && !grids_[t].dropped)
        open.push_back(t);
    if (open.empty())
      return false;
    const WhitenedProducts sums = whitened_products(models(open), series_.topRows(1));
    for (std::size_t place = 0; place < open.size(); ++place)
      for (Eigen::Index i = 0; i < kPoints; ++i) {
        const Eigen::Index node = static_cast<Eigen::Index>(place) * kPoints + i;
        grids_[open[place]].log_likelihood(i) = likelihood_(sums.log_determinant(node), sums.of(0, 0)(node));
      }
    return true;
  }

  void drop_hopeless(double margin) {
    double best = -kInfinity;
    for (const SizeGrid& grid : grids_)
      best = std::max(best, grid.log_likelihood.maxCoeff());
    for (SizeGrid& grid : grids_)
      grid.dropped = grid.dropped || grid.log_likelihood.maxCoeff() < best - margin;
  }

  WeighedModels collected() const {
    std::vector<std::size_t> kept;
    for (std::size_t t = 0; t < grids_.size(); ++t)
      if (!grids_[t].dropped)
        kept.push_back(t);
    WeighedModels nodes{models(kept), {}, {}};
    nodes.log_prior.resize(nodes.models.count());
    nodes.log_likelihood.resize(nodes.models.count());
    Eigen::Index node = 0;
    for (const std::size_t t : kept)
      for (Eigen::Index i = 0; i < kPoints; ++i, ++node) {
        const SizeGrid& grid = grids_[t];
        const double size = std::exp(grid.log_size(i));
        const double end = i == 0 || i == kPoints - 1 ? 0.5 : 1.0;  // of the trapezoidal rule
        // By rounding, the ends of the grid may lie beyond the support.
        const auto [low, high] = support(prior_[t].size);
        nodes.log_prior(node) = std::log(prior_[t].weight * end * grid.spacing() * size *
                                         density(prior_[t].size, std::clamp(size, low, high)));
        nodes.log_likelihood(node) = grid.log_likelihood(i);
      }
    return series_.rows() == 1 ? nodes : with_directions(nodes.within(kOutside));
  }

  WeighedModels with_directions(WeighedModels nodes) const {
    const WhitenedProducts sums =
        marginalised(whitened_products(nodes.models, series_), 1, series_.rows() - 1);
    for (Eigen::Index node = 0; node < nodes.models.count(); ++node)
      nodes.log_likelihood(node) = likelihood_(sums.log_determinant(node), sums.of(0, 0)(node));
    return nodes;
  }

  const std::vector<DisturbancePrior>& prior_;
  const BaseNoise& base_;
  bool rest_;
  const ScaleLikelihood& likelihood_;
  const Eigen::Ref<const Eigen::MatrixXd>& series_;
  std::vector<SizeGrid> grids_;
};

}  // namespace

double ScaleLikelihood::operator()(double log_determinant, double squares) const {
  if (std::isinf(freedom))
    return -0.5 * (log_determinant + squares);
  return -0.5 * (log_determinant + (freedom + samples) * std::log1p(squares / freedom));
}

double ScaleLikelihood::precision(double squares) const {
  return std::isinf(freedom) ? 1.0 : (freedom + samples) / (freedom + squares);
}

Eigen::Index WeighedModels::best() const {
  return required_best_candidate("likelihoods of the disturbances of a CV", log_likelihood) -
         log_likelihood.begin();
}

double WeighedModels::log_evidence() const {
  const Eigen::ArrayXd posterior = log_posterior();
  const double largest = *required_best_candidate("likelihoods of the disturbances of a CV", posterior);
  return largest + std::log((posterior - largest).exp().sum());
}

WeighedModels WeighedModels::main_ones() const {
  return within(kNegligible);
}

WeighedModels WeighedModels::within(double margin) const {
  const Eigen::ArrayXd posterior = log_posterior();
  const double least = *required_best_candidate("likelihoods of the noises of a CV", posterior) - margin;
  std::vector<Eigen::Index> places;
  for (Eigen::Index i = 0; i < posterior.size(); ++i)
    if (posterior(i) >= least)
      places.push_back(i);
  return {{models.a(places), models.b(places), models.phi, models.starts_from_rest},
          log_prior(places),
          log_likelihood(places)};
}

WeighedModels WeighedModels::only(Eigen::Index place) const {
  return {{models.a.segment(place, 1), models.b.segment(place, 1), models.phi, models.starts_from_rest},
          log_prior.segment(place, 1),
          log_likelihood.segment(place, 1)};
}

WeighedModels base_models(const BaseNoise& base, bool starts_from_rest) {
  return {
      {Eigen::ArrayXd::Constant(1, base.a), Eigen::ArrayXd::Constant(1, base.b), base.phi, starts_from_rest},
      Eigen::ArrayXd::Zero(1),
      Eigen::ArrayXd::Zero(1)};
}

WeighedModels scan_disturbances(const std::vector<DisturbancePrior>& prior, const BaseNoise& base,
                                bool starts_from_rest, const ScaleLikelihood& likelihood,
                                const Eigen::Ref<const Eigen::MatrixXd>& series) {
  return DisturbanceScan(prior, base, starts_from_rest, likelihood, series).run();
}

}  // namespace mpm
