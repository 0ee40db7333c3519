#include "analysis/methods/ours/growing_mismatch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "analysis/identification/kalman_whitening.hpp"
#include "analysis/methods/ours/fault_priors.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// The grid: onsets and growths as shares of the record, and sizes of a parameter that is not linear.
constexpr std::array kTriedOnsets{0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75};
constexpr std::array kTriedGrowths{0.05, 0.25, 0.5};
constexpr std::size_t kTriedSizes = 6;
constexpr double kMostStretch = 1.5;  // of the response at a size of the grid
constexpr std::size_t kMostRefined = 3;
constexpr double kFarFromBest = 60.0;  // behind the best, in half the squares that a parameter explains
constexpr int kMostRefinements = 10, kMostHalvings = 4;
constexpr double kEnough = 0.02;  // gain of log L by a step; less ends the search
constexpr double kShortestGrowth = 1.0;

/// Size, onset and end.
using Growth = Eigen::Vector3d;

Eigen::RowVectorXd ramp(Eigen::Index samples, double onset, double end) {
  const double growth = std::max(end - onset, kShortestGrowth);
  Eigen::RowVectorXd share(samples);
  for (Eigen::Index k = 0; k < samples; ++k)
    share(k) = std::clamp((static_cast<double>(k) - onset) / growth, 0.0, 1.0);
  return share;
}

/// Products of whitened rows without what the directions explain.
class Explained {
 public:
  Explained(const Eigen::Ref<const Eigen::RowVectorXd>& e, const Eigen::Ref<const Eigen::MatrixXd>& Z)
      : e_(e), Z_(Z), inner_(Z * Z.transpose() + Eigen::MatrixXd::Identity(Z.rows(), Z.rows())) {
    e_in_Z_ = inner_.matrixL().solve(Z_ * e_.transpose());
  }

  /// The squares of e that t m explains, with t between 1 / `most` and `most`.
  double by(const Eigen::RowVectorXd& m, double most) const {
    const Eigen::VectorXd in_Z = inner_.matrixL().solve(Z_ * m.transpose());
    const double squares = m.squaredNorm() - in_Z.squaredNorm();
    const double product = e_.dot(m) - e_in_Z_.dot(in_Z);
    if (!(squares > 0.0))
      return 0.0;
    const double t = std::clamp(product / squares, 1.0 / most, most);
    return t * (2.0 * product - t * squares);
  }

 private:
  Eigen::RowVectorXd e_;
  Eigen::MatrixXd Z_;
  Eigen::LLT<Eigen::MatrixXd> inner_;
  Eigen::VectorXd e_in_Z_;
};

class GrowingSearch {
 public:
  GrowingSearch(WeighedModels base, double deviation, const ScaleLikelihood& likelihood,
                const std::vector<MismatchResponses>& responses,
                const Eigen::Ref<const Eigen::MatrixXd>& series,
                const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                const Eigen::Ref<const Eigen::VectorXd>& initial, const DirectionsOfGrowing& directions)
      : base_(std::move(base)),
        deviation_(deviation),
        likelihood_(likelihood),
        responses_(responses),
        series_(series),
        inputs_(inputs),
        initial_(initial),
        directions_(directions),
        samples_(series.cols()) {}

  std::vector<GrowingMismatch> run() const {
    std::vector<Start> starts;
    for (std::size_t i = 0; i < responses_.size(); ++i)
      if (const Start start = best_of_grid(i); !std::isnan(start.explained))
        starts.push_back(start);
    std::sort(starts.begin(), starts.end(),
              [](const Start& a, const Start& b) { return a.explained > b.explained; });
    std::vector<GrowingMismatch> found;
    for (const Start& start : starts) {
      if (found.size() == kMostRefined || start.explained < starts.front().explained - 2.0 * kFarFromBest)
        break;
      if (const std::optional<GrowingMismatch> refined = refine(start))
        found.push_back(*refined);
    }
    return found;
  }

 private:
  struct Start {
    std::size_t mismatch;
    Growth at;
    double explained;
  };

  /// A point of the search: log L there, its slopes, and the information about size, onset and end.
  struct Look {
    double log_likelihood;
    Eigen::Vector3d slope;
    Eigen::Matrix3d information;
  };

  double record() const { return static_cast<double>(samples_); }
  Eigen::RowVectorXd input(std::size_t i) const { return inputs_.row(responses_[i].prior().channel.mv); }
  double initial(std::size_t i) const { return initial_(responses_[i].prior().channel.mv); }

  /// A few sizes of the grid of a parameter, or 0 and 2 for a gain, whose response is linear.
  std::vector<double> tried_sizes(std::size_t i) const {
    if (responses_[i].is_linear())
      return {0.0, 2.0};
    const std::vector<double>& all = responses_[i].sizes();
    std::vector<double> sizes;
    const std::size_t count = std::min(kTriedSizes, all.size());
    for (std::size_t n = 0; n < count; ++n)
      sizes.push_back(all[n * (all.size() - 1) / (count - 1)]);
    return sizes;
  }

  Start best_of_grid(std::size_t i) const {
    const std::vector<double> sizes = tried_sizes(i);
    const Eigen::Index q = series_.rows() - 1;
    Eigen::MatrixXd rows(1 + q + static_cast<Eigen::Index>(sizes.size()), samples_);
    rows.topRows(1 + q) = series_;
    for (std::size_t n = 0; n < sizes.size(); ++n)
      rows.row(1 + q + static_cast<Eigen::Index>(n)) =
          responses_[i].at(sizes[n], input(i), initial(i)) / deviation_;
    double unused = 0.0;
    // A ramp changes slowly against the memory of the noise, so it may multiply the whitened response.
    const Eigen::MatrixXd white = whitened(base_.models, rows, unused);
    const Explained explained(white.row(0), white.middleRows(1, q));
    const double most = responses_[i].is_linear() ? 1e3 : kMostStretch;
    Start best{i, {1.0, 0.0, 0.0}, -kInfinity};
    for (const double onset : kTriedOnsets)
      for (const double growth : kTriedGrowths) {
        const Eigen::RowVectorXd share = ramp(samples_, onset * record(), (onset + growth) * record());
        for (std::size_t n = 0; n < sizes.size(); ++n) {
          const Eigen::RowVectorXd m = white.row(1 + q + static_cast<Eigen::Index>(n)).cwiseProduct(share);
          const double squares = explained.by(m, most);
          if (squares > best.explained)
            best = {i, {sizes[n], onset * record(), (onset + growth) * record()}, squares};
        }
      }
    return best;
  }

  using Response = Eigen::RowVectorXd (MismatchResponses::*)(double,
                                                             const Eigen::Ref<const Eigen::RowVectorXd>&,
                                                             double) const;

  /// The response, or its slope, if this part (N) of the mismatch is present at each sample, as in
  /// ChangingPlant: a gain changes at the input, anything else at the output.
  Eigen::RowVectorXd of_part(Response what, std::size_t i, double size,
                             const Eigen::RowVectorXd& part) const {
    const MismatchResponses& response = responses_[i];
    if (response.is_linear())
      return (response.*what)(size, input(i).cwiseProduct(part), 0.0) / deviation_;
    return (response.*what)(size, input(i), initial(i)).cwiseProduct(part) / deviation_;
  }

  /// log L, except for what all hypotheses share, and its slopes.
  Look look(std::size_t i, const Growth& at, const Eigen::Ref<const Eigen::MatrixXd>& directions) const {
    const Eigen::Index q = directions.rows();
    const Eigen::RowVectorXd share = ramp(samples_, at(1), at(2));
    const auto response = [&](const Eigen::RowVectorXd& part) {
      return of_part(&MismatchResponses::at, i, at(0), part);
    };
    Eigen::MatrixXd rows(4 + q, samples_);
    rows.row(0) = series_.row(0) - response(share);
    rows.row(1) = of_part(&MismatchResponses::slope, i, at(0), share);
    rows.row(2) = response(ramp(samples_, at(1) + 1.0, at(2)) - share);
    rows.row(3) = response(ramp(samples_, at(1), at(2) + 1.0) - share);
    rows.bottomRows(q) = directions;
    const WhitenedProducts sums = marginalised(whitened_products(base_.models, rows), 4, q);
    Look found{likelihood_(sums.log_determinant(0), sums.of(0, 0)(0)), {}, {}};
    const double precision = likelihood_.precision(sums.of(0, 0)(0));
    for (Eigen::Index row = 0; row < 3; ++row) {
      found.slope(row) = precision * sums.of(row + 1, 0)(0);
      for (Eigen::Index column = 0; column < 3; ++column)
        found.information(row, column) = precision * sums.of(row + 1, column + 1)(0);
    }
    return found;
  }

  Growth within(std::size_t i, Growth at) const {
    const auto [low, high] = support(responses_[i].prior().size);
    at(0) = std::clamp(at(0), low, high);
    at(1) = std::clamp(at(1), 0.0, record() - 1.0);
    at(2) = std::clamp(at(2), at(1) + kShortestGrowth, at(1) + record());
    return at;
  }

  /// Adds the information of the prior, so that no standard deviation is larger than the width of the
  /// possible range.
  Eigen::Matrix3d with_prior(std::size_t i, Eigen::Matrix3d information) const {
    const auto [low, high] = support(responses_[i].prior().size);
    const Eigen::Array3d widths(high - low, record(), record());
    information.diagonal().array() += 2.0 * std::numbers::pi / widths.square();
    return information;
  }

  std::optional<GrowingMismatch> refine(const Start& start) const {
    const std::size_t i = start.mismatch;
    Growth at = within(i, start.at);
    climb(i, series_.bottomRows(series_.rows() - 1), at);
    const Eigen::MatrixXd directions = directions_(i, at(0), ramp(samples_, at(1), at(2)));
    const Look here = climb(i, directions, at);
    return evidence(i, at, here);
  }

  /// Climbs to the largest likelihood, from `at` on.
  Look climb(std::size_t i, const Eigen::Ref<const Eigen::MatrixXd>& directions, Growth& at) const {
    Look here = look(i, at, directions);
    for (int step = 0; step < kMostRefinements; ++step) {
      Growth move = with_prior(i, here.information).llt().solve(here.slope);
      double gained = 0.0;
      for (int halving = 0; halving < kMostHalvings; ++halving, move *= 0.5) {
        const Growth next = within(i, at + move);
        const Look there = look(i, next, directions);
        if (there.log_likelihood <= here.log_likelihood)
          continue;
        gained = there.log_likelihood - here.log_likelihood;
        at = next;
        here = there;
        break;
      }
      if (gained < kEnough)
        break;
    }
    return here;
  }

  std::optional<GrowingMismatch> evidence(std::size_t i, const Growth& at, const Look& here) const {
    const SizePrior& prior = responses_[i].prior();
    const auto [low, high] = support(prior.size);
    const Eigen::Matrix3d information = with_prior(i, here.information);
    const double determinant = information.determinant();
    const double density_there = density(prior.size, at(0));
    if (!(determinant > 0.0 && density_there > 0.0))
      return std::nullopt;
    const double log_mass = here.log_likelihood + std::log(density_there / (record() * record())) +
                            1.5 * std::log(2.0 * std::numbers::pi) - 0.5 * std::log(determinant);
    const double size_deviation = std::sqrt(information.inverse()(0, 0));
    return GrowingMismatch{i,     {log_mass + std::log(prior.weight), at(0), size_deviation, low, high},
                           at(0), at(1),
                           at(2), here.log_likelihood};
  }

  WeighedModels base_;
  double deviation_;
  ScaleLikelihood likelihood_;
  const std::vector<MismatchResponses>& responses_;
  const Eigen::Ref<const Eigen::MatrixXd>& series_;
  const Eigen::Ref<const Eigen::MatrixXd>& inputs_;
  const Eigen::Ref<const Eigen::VectorXd>& initial_;
  const DirectionsOfGrowing& directions_;
  Eigen::Index samples_;
};

}  // namespace

std::vector<GrowingMismatch> growing_mismatches(const BaseNoise& noise, bool starts_from_rest,
                                                const ScaleLikelihood& likelihood,
                                                const std::vector<MismatchResponses>& responses,
                                                const Eigen::Ref<const Eigen::MatrixXd>& series,
                                                const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                                const Eigen::Ref<const Eigen::VectorXd>& initial,
                                                const DirectionsOfGrowing& directions) {
  return GrowingSearch(base_models(noise, starts_from_rest), noise.deviation, likelihood, responses, series,
                       inputs, initial, directions)
      .run();
}

}  // namespace mpm
