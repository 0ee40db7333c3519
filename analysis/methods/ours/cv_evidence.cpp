#include "analysis/methods/ours/cv_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>

#include "analysis/methods/ours/any_shape.hpp"
#include "analysis/methods/ours/growing_mismatch.hpp"
#include "analysis/statistics/best_candidate.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// Differences of log L. A fault that gains less than kFaint, or kWorthALook, is not worth a closer look, and
/// neither is one that is kLost behind the best.
constexpr double kFaint = 5.0, kWorthALook = 2.0, kLost = 12.0;
constexpr std::size_t kMostLooks = 4;
constexpr int kMostSteps = 4;    // of the refinement of a size
constexpr double kStill = 0.3;   // a size that moves by less stands still, in its standard deviations
constexpr double kNarrow = 0.2;  // of the possible range: in a narrower posterior the slope says all about m
constexpr double kNoWeight = 1e-9;  // of a part of the posterior

/// SSE(t) = squares - 2 t product + t^2 slope_squares, of e - t m.
struct Parabola {
  double squares, product, slope_squares;

  double operator()(double t) const { return squares - 2.0 * t * product + t * t * slope_squares; }
};

/// A cell of sizes theta = origin + scale t, with t from `low` to `high`.
struct SizeCell {
  double origin, scale;
  double low, high;  ///< of t
};

struct CellEvidence {
  TruncatedNormal size;
  double best_size, best_log_likelihood;
};

CellEvidence cell_evidence(const Parabola& squares, const SizeCell& cell, const Distribution& prior,
                           double log_determinant, const ScaleLikelihood& likelihood) {
  const bool moves = squares.slope_squares > 0.0;
  const double mean = moves ? squares.product / squares.slope_squares : 0.5 * (cell.low + cell.high);
  const double best = std::clamp(mean, cell.low, cell.high);
  const double least = std::max(squares(best), 0.0);
  const double deviation =
      moves ? 1.0 / std::sqrt(likelihood.precision(least) * squares.slope_squares) : kInfinity;
  const double off = (best - mean) / deviation;
  const double log_likelihood = likelihood(log_determinant, least);
  const double size = cell.origin + cell.scale * best;
  const auto [lowest, highest] = support(prior);
  const double log_density = std::log(density(prior, std::clamp(size, lowest, highest)) * cell.scale);
  return {{log_likelihood + 0.5 * off * off + log_normal_integral(cell.low, cell.high, mean, deviation) +
               log_density,
           cell.origin + cell.scale * mean, cell.scale * deviation, cell.origin + cell.scale * cell.low,
           cell.origin + cell.scale * cell.high},
          size,
          log_likelihood};
}

MismatchEvidence nothing_yet() {
  return {-kInfinity, kNaN, -kInfinity, {}};
}

void add(MismatchEvidence& evidence, const CellEvidence& cell) {
  evidence.log_evidence = log_sum(evidence.log_evidence, cell.size.log_mass);
  evidence.sizes.push_back(cell.size);
  if (cell.best_log_likelihood > evidence.best_log_likelihood) {
    evidence.best_log_likelihood = cell.best_log_likelihood;
    evidence.best_size = cell.best_size;
  }
}

/// The same evidence, with its probability multiplied by a factor.
MismatchEvidence weighed(MismatchEvidence evidence, double log_weight) {
  evidence.log_evidence += log_weight;
  for (TruncatedNormal& part : evidence.sizes)
    part.log_mass += log_weight;
  return evidence;
}

double sum_of(const std::vector<MismatchEvidence>& all) {
  double sum = -kInfinity;
  for (const MismatchEvidence& each : all)
    sum = log_sum(sum, each.log_evidence);
  return sum;
}

/// The noises that the benchmark leaves possible for the record of a CV.
class RecordNoises {
 public:
  RecordNoises(const ModelErrors& model, const ScaleLikelihood& likelihood, bool rest)
      : model_(model), base_(model.noise()), likelihood_(likelihood), rest_(rest) {}

  static Eigen::MatrixXd stacked(const Eigen::Ref<const Eigen::MatrixXd>& rows,
                                 const Eigen::Ref<const Eigen::MatrixXd>& directions) {
    Eigen::MatrixXd all(rows.rows() + directions.rows(), rows.cols());
    all << rows, directions;
    return all;
  }

  /// The likelihood of the first of the series under each model.
  Eigen::ArrayXd log_likelihoods(const WhitenedProducts& sums) const {
    const Eigen::ArrayXd& squares = sums.of(0, 0);
    Eigen::ArrayXd all(squares.size());
    for (Eigen::Index i = 0; i < all.size(); ++i)
      all(i) = likelihood_(sums.log_determinant(i), squares(i));
    return all;
  }

  /// Products of the series; the directions are integrated out.
  static WhitenedProducts products(const NoiseModels& models, const Eigen::Ref<const Eigen::MatrixXd>& series,
                                   const Eigen::Ref<const Eigen::MatrixXd>& directions) {
    return marginalised(whitened_products(models, stacked(series, directions)), series.rows(),
                        directions.rows());
  }

  /// log of the mean likelihood of the first of the series over the noises that the benchmark leaves
  /// possible, less that of the fitted one. Calls `under` with each set of noises and the products under
  /// them.
  template <class Under>
  double gain_of_other_noises(const Eigen::Ref<const Eigen::MatrixXd>& series,
                              const Eigen::Ref<const Eigen::MatrixXd>& directions, Under under) const {
    if (model_.noises().possible.empty())
      return 0.0;
    double mean = -kInfinity;
    for (const PossibleNoises& possible : model_.noises().possible) {
      const NoiseModels models{possible.a, possible.b, possible.phi, rest_};
      // Most of the noises are hopeless, and the first of the series alone shows which.
      const WeighedModels noises =
          WeighedModels{models, possible.log_weight,
                        log_likelihoods(whitened_products(models, series.topRows(1)))}
              .within(kLost);
      const WhitenedProducts sums = products(noises.models, series, directions);
      under(noises, sums);
      for (const double each : (noises.log_prior + log_likelihoods(sums)).eval())
        mean = log_sum(mean, each);
    }
    return mean - under_fitted(series, directions);
  }

  /// log L of the first of the series under the fitted noise.
  double under_fitted(const Eigen::Ref<const Eigen::MatrixXd>& series,
                      const Eigen::Ref<const Eigen::MatrixXd>& directions) const {
    return log_likelihoods(products(base_models(base_, rest_).models, series.topRows(1), directions))(0);
  }

 protected:
  const ModelErrors& model_;
  const BaseNoise& base_;
  ScaleLikelihood likelihood_;
  bool rest_;
};

/// Computes the evidence that one record gives.
class RecordLikelihood : private RecordNoises {
 public:
  RecordLikelihood(const ModelErrors& model, const CvPrior& prior, const ScaleLikelihood& likelihood,
                   bool rest, const std::vector<MismatchResponses>& responses, const Eigen::RowVectorXd& e,
                   const Eigen::Ref<const Eigen::MatrixXd>& u,
                   const Eigen::Ref<const Eigen::VectorXd>& initial_u, Eigen::MatrixXd slopes,
                   JudgedMismatches judged)
      : RecordNoises(model, likelihood, rest),
        prior_(prior),
        responses_(responses),
        e_(e),
        u_(u),
        initial_u_(initial_u),
        slopes_(std::move(slopes)),
        judged_(judged),
        directions_(model.directions(slopes_)) {
    simulate();
  }

  CvEvidence evidence() const {
    const WeighedModels base = base_models(base_, rest_);
    CvEvidence evidence{};
    evidence.mismatch_alone = on_grids(base, &evidence.healthy);
    const double fitted_alone = evidence.healthy;
    const double of_others = gain_of_other_noises(e_, directions_, [](const auto&, const auto&) {});
    evidence.healthy += of_others;
    // Looks again at all of them, however far behind the best: between two sizes of a grid a likelihood may
    // lose more than any margin when e is large against the noise.
    std::vector<bool> is_narrow(responses_.size(), false);
    for (std::size_t i = 0; i < responses_.size(); ++i)
      if (evidence.mismatch_alone[i].best_log_likelihood > fitted_alone + kFaint)
        is_narrow[i] = look_again(i, false, evidence.mismatch_alone[i]);
    count_other_noises(of_others, is_narrow, evidence.mismatch_alone);
    const WeighedModels disturbances = scan(e_, directions_);
    evidence.ud = disturbances.log_evidence();
    const Eigen::Index strongest = disturbances.best();
    evidence.disturbance_a = disturbances.models.a(strongest);
    evidence.disturbance_b = base_.deviation * disturbances.models.b(strongest);
    evidence.mismatch_with_disturbance = with_disturbance(evidence, disturbances);
    evidence.mpm = sum_of(evidence.mismatch_alone);
    evidence.both = sum_of(evidence.mismatch_with_disturbance);
    return evidence;
  }

 private:
  Eigen::RowVectorXd input(std::size_t i) const { return u_.row(responses_[i].prior().channel.mv); }
  double initial(std::size_t i) const { return initial_u_(responses_[i].prior().channel.mv); }

  Eigen::RowVectorXd response(std::size_t i, double size) const {
    return responses_[i].at(size, input(i), initial(i)) / base_.deviation;
  }

  void simulate() {
    std::vector<Eigen::MatrixXd> grids;
    Eigen::Index rows = 1;
    for (std::size_t i = 0; i < responses_.size(); ++i) {
      first_row_.push_back(rows);
      grids.emplace_back(responses_[i].on_grid(input(i), initial(i)) / base_.deviation);
      rows += grids.back().rows();
    }
    series_.resize(rows + directions_.rows(), e_.size());
    series_.row(0) = e_;
    series_.bottomRows(directions_.rows()) = directions_;
    for (std::size_t i = 0; i < grids.size(); ++i)
      series_.middleRows(first_row_[i], grids[i].rows()) = grids[i];
  }

  /// The directions of what is unknown about the model if it has this mismatch.
  Eigen::MatrixXd directions_with(std::size_t i, double size) const {
    const SizePrior& prior = responses_[i].prior();
    return model_.directions(
        model_.slopes(slopes_, {0, prior.channel.mv, prior.parameter, size}, u_, initial_u_));
  }

  WeighedModels scan(const Eigen::Ref<const Eigen::MatrixXd>& e,
                     const Eigen::Ref<const Eigen::MatrixXd>& directions) const {
    return scan_disturbances(prior_.disturbances, base_, rest_, likelihood_, stacked(e, directions));
  }

  /// The whitened series without the directions: the part of each series that the directions cannot explain,
  /// in N + q numbers, so that products of these parts are those of marginalised(). Adds log |I + Z Z'| to
  /// `log_determinant`.
  Eigen::MatrixXd whitened_series(const NoiseModels& models, double& log_determinant) const {
    Eigen::MatrixXd white = whitened(models, series_, log_determinant);
    const Eigen::Index q = directions_.rows(), rows = white.rows() - q;
    if (q == 0)
      return white;
    const auto Z = white.bottomRows(q);
    const Eigen::LLT<Eigen::MatrixXd> inner(Z * Z.transpose() + Eigen::MatrixXd::Identity(q, q));
    log_determinant += 2.0 * inner.matrixLLT().diagonal().array().log().sum();
    // w - (w Z') (I + Z Z')^-1 [Z, I]: the residual of the least squares of [w, 0] on [Z, I].
    const Eigen::MatrixXd coefficients = inner.solve(Z * white.topRows(rows).transpose()).transpose();
    Eigen::MatrixXd left(rows, white.cols() + q);
    left << white.topRows(rows) - coefficients * Z, -coefficients;
    return left;
  }

  /// The evidence of all mismatches on their grids, under one model of the noise. Sets `without` to the
  /// likelihood without a mismatch.
  std::vector<MismatchEvidence> on_grids(const WeighedModels& model, double* without) const {
    double log_determinant = 0.0;
    const Eigen::MatrixXd white = whitened_series(model.models, log_determinant);
    const Eigen::Index rows = white.rows();
    Eigen::ArrayXd with_e = Eigen::ArrayXd::Zero(rows), squares = with_e, with_next = with_e.head(rows - 1);
    for (Eigen::Index k = 0; k < white.cols(); ++k) {
      with_e += white(0, k) * white.col(k).array();
      squares += white.col(k).array().square();
      with_next += white.col(k).head(rows - 1).array() * white.col(k).tail(rows - 1).array();
    }
    *without = likelihood_(log_determinant, squares(0));
    std::vector<MismatchEvidence> all;
    for (std::size_t i = 0; i < responses_.size(); ++i) {
      const MismatchResponses& response = responses_[i];
      MismatchEvidence evidence = nothing_yet();
      const std::vector<double>& sizes = response.sizes();
      for (std::size_t c = 0; c + 1 < sizes.size(); ++c) {
        const double width = sizes[c + 1] - sizes[c];
        const Eigen::Index row = first_row_[i] + (response.is_linear() ? 0 : static_cast<Eigen::Index>(c));
        Parabola parabola{};
        if (response.is_linear()) {
          const double at = sizes[c] - 1.0;  // of G0 u
          parabola = {squares(0) - 2.0 * at * with_e(row) + at * at * squares(row),
                      width * (with_e(row) - at * squares(row)), width * width * squares(row)};
        } else {
          const double difference_squares =
              std::max(squares(row) + squares(row + 1) - 2.0 * with_next(row), 0.0);
          parabola = {squares(0) - 2.0 * with_e(row) + squares(row),
                      with_e(row + 1) - with_e(row) - with_next(row) + squares(row), difference_squares};
        }
        add(evidence, cell_evidence(parabola, {sizes[c], width, 0.0, 1.0}, response.prior().size,
                                    log_determinant, likelihood_));
      }
      all.push_back(weighed(std::move(evidence), std::log(response.prior().weight)));
    }
    return all;
  }

  /// Computes the evidence of one mismatch around its best size, with the exact m and its slope there, under
  /// the base noise or under the disturbances in what m leaves. If the posterior is narrow enough for a
  /// slope, replaces `evidence` and returns true.
  bool look_again(std::size_t i, bool disturbed, MismatchEvidence& evidence) const {
    const MismatchResponses& response = responses_[i];
    const auto [low, high] = support(response.prior().size);
    double size = evidence.best_size;
    MismatchEvidence closer = nothing_yet();
    for (int step = 0; step < kMostSteps; ++step) {
      const Eigen::MatrixXd pair = error_and_slope(i, size), directions = directions_with(i, size);
      const WeighedModels models =
          disturbed ? scan(pair.row(0), directions).main_ones() : base_models(base_, rest_);
      closer = nothing_yet();
      add_sizes(i, size, models, products(models.models, pair, directions), closer);
      double mean = 0.0, deviation = 0.0, total = 0.0;
      for (const TruncatedNormal& part : closer.sizes) {
        const double weight = std::exp(part.log_mass - closer.log_evidence);
        if (weight < kNoWeight)
          continue;
        mean += weight * std::clamp(part.mean, low, high);
        deviation += weight * part.deviation;
        total += weight;
      }
      if (!(total > 0.0))
        return false;
      mean /= total;
      deviation /= total;
      if (!response.is_linear() && deviation > kNarrow * (high - low))
        return false;
      const bool still = std::abs(mean - size) < kStill * deviation;
      size = mean;
      if (still)
        break;
    }
    closer.best_size = size;
    evidence = weighed(std::move(closer), std::log(response.prior().weight));
    return true;
  }

  /// What a mismatch of this size leaves of the errors, and its slope there.
  Eigen::MatrixXd error_and_slope(std::size_t i, double size) const {
    Eigen::MatrixXd pair(2, e_.size());
    pair.row(0) = e_ - response(i, size);
    pair.row(1) = responses_[i].slope(size, input(i), initial(i)) / base_.deviation;
    return pair;
  }

  /// Adds the sizes around `size` under each of the models, from the products of error_and_slope().
  void add_sizes(std::size_t i, double size, const WeighedModels& models, const WhitenedProducts& sums,
                 MismatchEvidence& evidence) const {
    const Distribution& prior = responses_[i].prior().size;
    const auto [low, high] = support(prior);
    for (Eigen::Index node = 0; node < models.models.count(); ++node) {
      const Parabola parabola{sums.of(0, 0)(node), sums.of(1, 0)(node), sums.of(1, 1)(node)};
      CellEvidence cell = cell_evidence(parabola, {size, 1.0, low - size, high - size}, prior,
                                        sums.log_determinant(node), likelihood_);
      cell.size.log_mass += models.log_prior(node);
      add(evidence, cell);
    }
  }

  /// Judges the mismatches that JudgedMismatches selects under all possible noises. The others gain what
  /// these noises bring `without` a fault. A narrow mismatch gets its sizes under all of these noises.
  void count_other_noises(double without, const std::vector<bool>& is_narrow,
                          std::vector<MismatchEvidence>& mismatches) const {
    std::vector<std::size_t> order(mismatches.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return mismatches[a].best_log_likelihood > mismatches[b].best_log_likelihood;
    });
    const double nearest = order.empty() ? 0.0 : mismatches[order.front()].best_log_likelihood - kWorthALook;
    double leading = -kInfinity;  // log likelihood of the best so far, under all noises
    for (const std::size_t i : order) {
      const double alone = mismatches[i].best_log_likelihood;
      const bool might_lead = judged_ == JudgedMismatches::all && alone + without > leading - kLost;
      if (!(alone > nearest) && !might_lead) {
        mismatches[i] = weighed(std::move(mismatches[i]), without);
        continue;
      }
      leading = std::max(leading, alone + under_other_noises(is_narrow[i], i, mismatches[i]));
    }
  }

  /// Judges a mismatch under all possible noises; returns what its log L gains from them.
  double under_other_noises(bool is_narrow, std::size_t i, MismatchEvidence& mismatch) const {
    const double size = mismatch.best_size;
    MismatchEvidence under_all = nothing_yet();
    const double gain = gain_of_other_noises(error_and_slope(i, size), directions_with(i, size),
                                             [&](const WeighedModels& noises, const WhitenedProducts& sums) {
                                               add_sizes(i, size, noises, sums, under_all);
                                             });
    mismatch = weighed(std::move(mismatch), gain);
    if (is_narrow && !under_all.sizes.empty()) {
      const double to_same_mass = mismatch.log_evidence - under_all.log_evidence;
      mismatch.sizes = weighed(std::move(under_all), to_same_mass).sizes;
    }
    return gain;
  }

  /// The evidence of mismatches beside a disturbance. They are searched for beside the disturbance that is
  /// best alone, and beside the one that the best mismatch alone leaves. The best of them are looked at
  /// again; for the others the disturbance is as without them.
  std::vector<MismatchEvidence> with_disturbance(const CvEvidence& so_far,
                                                 const WeighedModels& disturbances) const {
    std::vector<MismatchEvidence> all;
    double without = 0.0;
    const std::vector<MismatchEvidence> first = on_grids(disturbances.only(disturbances.best()), &without);
    for (const MismatchEvidence& each : first)
      all.push_back(weighed(each, so_far.ud - without));
    std::vector<double> fits;
    for (const MismatchEvidence& each : first)
      fits.push_back(each.best_log_likelihood);
    const auto strongest = best_candidate(so_far.mismatch_alone, &MismatchEvidence::best_log_likelihood);
    if (strongest != so_far.mismatch_alone.end() &&
        strongest->best_log_likelihood > so_far.healthy + kFaint) {
      const auto place = static_cast<std::size_t>(strongest - so_far.mismatch_alone.begin());
      const WeighedModels left =
          scan(e_ - response(place, strongest->best_size), directions_with(place, strongest->best_size));
      double none = 0.0;
      const std::vector<MismatchEvidence> second = on_grids(left.only(left.best()), &none);
      const double likelihood_left = left.log_likelihood.maxCoeff();
      for (std::size_t i = 0; i < second.size(); ++i) {
        MismatchEvidence other = weighed(second[i], left.log_evidence() - likelihood_left);
        fits[i] = std::max(fits[i], second[i].best_log_likelihood);
        if (other.log_evidence > all[i].log_evidence)
          all[i] = std::move(other);
      }
    }
    for (std::size_t i = 0; i < all.size(); ++i)
      if (const MismatchEvidence& alone = so_far.mismatch_alone[i]; alone.best_log_likelihood > fits[i]) {
        fits[i] = alone.best_log_likelihood;
        all[i].best_size = alone.best_size;
      }
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < fits.size(); ++i)
      if (!std::isnan(fits[i]))
        order.push_back(i);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return fits[a] > fits[b]; });
    std::size_t looks = 0;
    for (const std::size_t i : order) {
      if (looks == kMostLooks || fits[i] < fits[order.front()] - kLost || fits[i] < without + kWorthALook)
        break;
      look_again(i, true, all[i]);
      ++looks;
    }
    return all;
  }

  const CvPrior& prior_;
  const std::vector<MismatchResponses>& responses_;
  const Eigen::RowVectorXd& e_;
  const Eigen::Ref<const Eigen::MatrixXd>& u_;
  const Eigen::Ref<const Eigen::VectorXd>& initial_u_;
  Eigen::MatrixXd slopes_;  ///< of ModelErrors
  JudgedMismatches judged_;
  Eigen::MatrixXd directions_;           ///< of ModelErrors
  Eigen::MatrixXd series_;               ///< e, every response on its grid, and the directions
  std::vector<Eigen::Index> first_row_;  ///< of each mismatch in `series_`
};

}  // namespace

CvLikelihood::CvLikelihood(ModelErrors model, double sample_time, const CvPrior& prior, double noise_freedom,
                           bool starts_from_rest, JudgedMismatches judged)
    : model_(std::move(model)),
      prior_(prior),
      freedom_(noise_freedom),
      starts_from_rest_(starts_from_rest),
      judged_(judged) {
  for (const SizePrior& mismatch : prior.mismatches)
    responses_.emplace_back(model_.model()(0, mismatch.channel.mv), sample_time, mismatch);
}

CvEvidence CvLikelihood::of(const Eigen::Ref<const Eigen::RowVectorXd>& e,
                            const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                            const Eigen::Ref<const Eigen::VectorXd>& initial,
                            const Eigen::Ref<const Eigen::MatrixXd>& untold) const {
  const BaseNoise& base = model_.noise();
  const Eigen::RowVectorXd scaled = (e - model_.correction(inputs, initial)) / base.deviation;
  const auto samples = static_cast<double>((!scaled.array().isNaN()).count());
  return RecordLikelihood(model_, prior_, {freedom_, samples}, starts_from_rest_, responses_, scaled, inputs,
                          initial, slopes(inputs, initial, untold), judged_)
      .evidence();
}

Eigen::MatrixXd CvLikelihood::slopes(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                     const Eigen::Ref<const Eigen::VectorXd>& initial,
                                     const Eigen::Ref<const Eigen::MatrixXd>& untold) const {
  const Eigen::MatrixXd of_errors = model_.slopes(inputs, initial);
  Eigen::MatrixXd all(of_errors.rows() + untold.rows(), inputs.cols());
  all << of_errors, kUntold * model_.noise().deviation * untold;
  return all;
}

Eigen::MatrixXd CvLikelihood::healthy_series(const Eigen::Ref<const Eigen::RowVectorXd>& e,
                                             const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                             const Eigen::Ref<const Eigen::VectorXd>& initial,
                                             const Eigen::Ref<const Eigen::MatrixXd>& untold) const {
  const Eigen::MatrixXd directions = model_.directions(slopes(inputs, initial, untold));
  Eigen::MatrixXd series(1 + directions.rows(), e.size());
  series << (e - model_.correction(inputs, initial)) / model_.noise().deviation, directions;
  return series;
}

double CvLikelihood::healthy_evidence(const Eigen::Ref<const Eigen::MatrixXd>& series) const {
  const auto samples = static_cast<double>((!series.row(0).array().isNaN()).count());
  const RecordNoises noises(model_, {freedom_, samples}, starts_from_rest_);
  const auto directions = series.bottomRows(series.rows() - 1);
  return noises.under_fitted(series, directions) +
         noises.gain_of_other_noises(series.topRows(1), directions, [](const auto&, const auto&) {});
}

void CvLikelihood::add_growing(const Eigen::Ref<const Eigen::MatrixXd>& series,
                               const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                               const Eigen::Ref<const Eigen::VectorXd>& initial,
                               const Eigen::Ref<const Eigen::MatrixXd>& untold, double share,
                               CvEvidence& evidence) const {
  const auto samples = static_cast<double>((!series.row(0).array().isNaN()).count());
  const Eigen::MatrixXd without = slopes(inputs, initial, untold);
  const auto directions = [&](std::size_t i, double size, const Eigen::RowVectorXd& part) {
    const SizePrior& prior = responses_[i].prior();
    const Eigen::MatrixXd with =
        model_.slopes(without, {0, prior.channel.mv, prior.parameter, size}, inputs, initial);
    return model_.directions(without + ((with - without).array().rowwise() * part.array()).matrix());
  };
  for (const GrowingMismatch& found :
       growing_mismatches(model_.noise(), starts_from_rest_, {freedom_, samples}, responses_, series, inputs,
                          initial, directions)) {
    TruncatedNormal size = found.size;
    size.log_mass += std::log(share);
    add(evidence.mismatch_alone[found.mismatch], {size, found.best_size, found.log_likelihood});
  }
  evidence.mpm = sum_of(evidence.mismatch_alone);
}

void CvLikelihood::add_any_shape(const Eigen::Ref<const Eigen::MatrixXd>& series,
                                 const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                 const Eigen::Ref<const Eigen::VectorXd>& initial, double share,
                                 CvEvidence& evidence) const {
  const std::vector<Eigen::MatrixXd> channels = any_shape_rows(responses_, inputs, initial);
  Eigen::MatrixXd all = series, gains = series;
  const double third = std::log(share / 3.0);
  double sum = -kInfinity;
  for (const Eigen::MatrixXd& channel : channels) {
    const Eigen::MatrixXd rows = channel / model_.noise().deviation;
    sum = log_sum(sum, third - std::log(static_cast<double>(channels.size())) +
                           healthy_evidence(RecordNoises::stacked(series, rows)));
    all = RecordNoises::stacked(all, rows);
    gains = RecordNoises::stacked(gains, rows.topRows(1));
  }
  sum = log_sum(sum, third + log_sum(healthy_evidence(all), healthy_evidence(gains)));
  evidence.mpm = log_sum(evidence.mpm, sum);
}

}  // namespace mpm
