#include "analysis/methods/literature/loop_autocovariance.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "analysis/methods/literature/channel_regressors.hpp"
#include "analysis/methods/literature/noise_model.hpp"
#include "analysis/methods/literature/prewhitened_groups.hpp"
#include "analysis/statistics/discrete_filter.hpp"
#include "base/error.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "solvers/lanes/kernel_choice.hpp"
#include "solvers/lanes/lane_vector.hpp"

namespace mpm {
namespace {

/// sum_l h(l) x(k - l) of each row of h, as long as x.
Eigen::MatrixXd convolved_rows(const Eigen::MatrixXd& h, const Eigen::VectorXd& x) {
  const Eigen::Index n = padded(x.size());
  Eigen::VectorXd past = Eigen::VectorXd::Zero(LaneKernels::kConvolutionBefore + n);
  past.segment(LaneKernels::kConvolutionBefore, x.size()) = x;
  LaneVector y(n);
  Eigen::MatrixXd rows(h.rows(), x.size());
  for (Eigen::Index row = 0; row < h.rows(); ++row) {
    const Eigen::VectorXd response = h.row(row);
    lane_kernels().convolve(response.data(), response.size(), past.data() + LaneKernels::kConvolutionBefore,
                            n, y.data());
    rows.row(row) = y.vector().head(x.size());
  }
  return rows;
}

/// Solves u = x + f u with f(0) = 0.
Eigen::VectorXd closed(const Eigen::VectorXd& f, const Eigen::VectorXd& x) {
  const Eigen::VectorXd reversed = f.reverse();
  Eigen::VectorXd u = x;
  for (Eigen::Index k = 1; k < x.size(); ++k) {
    const Eigen::Index n = std::min(k, f.size() - 1);
    u(k) += reversed.segment(f.size() - 1 - n, n).dot(u.segment(k - n, n));
  }
  return u;
}

/// Converts step responses, one row each, to impulse responses.
Eigen::MatrixXd differences(const Eigen::MatrixXd& step_response, double size) {
  Eigen::MatrixXd impulse_response = step_response / size;
  const Eigen::Index n = step_response.cols() - 1;
  impulse_response.rightCols(n) -= step_response.leftCols(n) / size;
  return impulse_response;
}

/// The study without hard limits, and without signals that move its loops.
Study unlimited_study(const Study& study, Eigen::Index samples) {
  Study unlimited = study;
  unlimited.controller.mv_hard = Limits::none(study.mv_count());
  unlimited.controller.cv_hard = Limits::none(study.cv_count());
  unlimited.simulation.samples = static_cast<int>(samples);
  unlimited.simulation.limit_steps.clear();
  unlimited.simulation.off.clear();
  return unlimited;
}

void require_ok(const Trajectory& loop) {
  if (loop.status != ControlStatus::ok)
    throw InputError("controller", "one without a solution when no limit is left", "one with");
}

/// The effect on the CVs of a channel that differs from the model: S_i D / (1 - Q_ji D), ny x N. Its input is
/// the move of MV `mv` that the loop would make if the channel were that of the model.
struct AddedPath {
  Eigen::Index mv;
  Eigen::MatrixXd response;
};

std::optional<AddedPath> added_path(const LinearLoop& loop, const ChannelDifference* changed,
                                    Eigen::Index samples) {
  if (!changed)
    return std::nullopt;
  const auto i = static_cast<std::size_t>(changed->cv);
  const Eigen::VectorXd f = convolved_rows(loop.q[i].row(changed->mv), changed->D).transpose();
  const Eigen::Index n = std::min(samples, changed->D.size());
  Eigen::VectorXd D = Eigen::VectorXd::Zero(samples);
  D.head(n) = changed->D.head(n);
  return AddedPath{changed->mv, convolved_rows(loop.s[i], closed(f, D))};
}

/// Adds the effect of these moves of the MVs along the path to the CVs, ny x n.
void add_along(const std::optional<AddedPath>& path, const Eigen::MatrixXd& u, Eigen::MatrixXd& cvs) {
  if (path)
    cvs += convolved_rows(path->response, u.row(path->mv));
}

/// n of the CVs for an impulse in each w_l, ny x L.
std::vector<Eigen::MatrixXd> noise_responses(const LinearLoop& loop, const std::optional<AddedPath>& path) {
  std::vector<Eigen::MatrixXd> responses = loop.noise_outputs;
  for (std::size_t l = 0; l < responses.size(); ++l)
    add_along(path, loop.noise_moves[l], responses[l]);
  return responses;
}

/// g_im(tau) = sum_l sum_t psi_il(t) psi_ml(t + tau).
double noise_covariance(const std::vector<Eigen::MatrixXd>& psi, Eigen::Index i, Eigen::Index m,
                        Eigen::Index tau) {
  double sum = 0.0;
  for (const Eigen::MatrixXd& each : psi) {
    const Eigen::Index n = each.cols() - std::abs(tau);
    if (n > 0)
      sum += tau >= 0 ? each.row(i).head(n).dot(each.row(m).tail(n))
                      : each.row(i).tail(n).dot(each.row(m).head(n));
  }
  return sum;
}

/// z_d, ny x N.
Eigen::MatrixXd moved_outputs(const OutsideMoves& moves, const std::optional<AddedPath>& path) {
  Eigen::MatrixXd z = moves.z0;
  add_along(path, moves.u0, z);
  return z.middleCols(moves.first, moves.samples);
}

/// x_ia of a row of z_d.
Eigen::VectorXd twice_shifted(const Eigen::VectorXd& z, Eigen::Index a) {
  const Eigen::Index n = z.size() - a;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(z.size());
  x.head(n) += z.tail(n);
  x.tail(n) += z.head(n);
  return x;
}

/// g_im(-L + 1) ... g_im(L - 1).
Eigen::VectorXd all_covariances(const std::vector<Eigen::MatrixXd>& psi, Eigen::Index i, Eigen::Index m) {
  const Eigen::Index L = psi.front().cols();
  Eigen::VectorXd g(2 * L - 1);
  for (Eigen::Index tau = 1 - L; tau < L; ++tau)
    g(tau + L - 1) = noise_covariance(psi, i, m, tau);
  return g;
}

/// sum_t g(t + a) g(t + b) for a g that is 0 beyond its ends.
double overlap(const Eigen::VectorXd& g, Eigen::Index a, Eigen::Index b) {
  const Eigen::Index apart = std::abs(b - a);
  const Eigen::Index n = g.size() - apart;
  return n > 0 ? g.head(n).dot(g.tail(n)) : 0.0;
}

/// sum_l g(l - k) x(l) at each k.
Eigen::VectorXd correlated(const Eigen::VectorXd& g, const Eigen::VectorXd& x) {
  const Eigen::Index L = (g.size() + 1) / 2;
  Eigen::VectorXd y(x.size());
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const Eigen::Index first = std::max<Eigen::Index>(0, k - L + 1);
    const Eigen::Index last = std::min(x.size() - 1, k + L - 1);
    y(k) = g.segment(first - k + L - 1, last - first + 1).dot(x.segment(first, last - first + 1));
  }
  return y;
}

}  // namespace

Eigen::VectorXd loop_autocovariance(const Eigen::Ref<const Eigen::MatrixXd>& z,
                                    const std::vector<Eigen::Index>& lags) {
  const auto count = static_cast<Eigen::Index>(lags.size());
  Eigen::VectorXd c(z.rows() * count);
  for (Eigen::Index i = 0; i < z.rows(); ++i)
    for (Eigen::Index a = 0; a < count; ++a) {
      const Eigen::Index n = z.cols() - lags[static_cast<std::size_t>(a)];
      c(i * count + a) = z.row(i).head(n).dot(z.row(i).tail(n)) / static_cast<double>(z.cols());
    }
  return c;
}

LinearLoop linear_loop(const AssessmentContext& context, const AssessedLoop& benchmark,
                       Eigen::Index samples) {
  const Study study = unlimited_study(context.study, samples);
  const Eigen::Index ny = study.cv_count();
  const Eigen::MatrixXd still = Eigen::MatrixXd::Zero(ny, samples);
  LinearLoop loop{.sample_time = study.controller.sample_time};
  Eigen::VectorXd impulse = Eigen::VectorXd::Zero(samples);
  impulse(0) = 1.0;
  for (Eigen::Index cv = 0; cv < ny; ++cv) {
    LoopSignals signals{
        .d = Eigen::MatrixXd::Zero(study.md_count(), samples), .noise = still, .y_d = still, .y_set = still};
    signals.y_d.row(cv).setConstant(study.sensitivity.step_size);
    const Trajectory step = run_closed_loop(study, study.plant.G, signals, context.factory);
    require_ok(step);
    loop.q.push_back(differences(step.u, study.sensitivity.step_size));
    loop.s.push_back(differences(step.y, study.sensitivity.step_size));
    const Eigen::VectorXd v = (benchmark.y.row(cv) - benchmark.y_sim.row(cv)).transpose();
    const NoiseModel model = autoregressive_noise((v.array() - v.mean()).matrix(), kHighestNoiseOrder);
    const Eigen::VectorXd noise =
        std::sqrt(innovation_variance(v, kHighestNoiseOrder)) * filter(model.C, model.D, impulse);
    loop.noise_moves.push_back(convolved_rows(loop.q.back(), noise));
    loop.noise_outputs.push_back(convolved_rows(loop.s.back(), noise));
  }
  return loop;
}

Eigen::MatrixXd control_errors(const AssessedLoop& loop, const Eigen::Ref<const Eigen::MatrixXd>& y) {
  Eigen::MatrixXd z = y;
  for (const Eigen::Index cv : loop.setpoint_cvs())
    z.row(cv) -= loop.y_set.row(cv);
  return z;
}

OutsideMoves outside_moves(const AssessmentContext& context, const AssessedLoop& loop) {
  const AssessedLoop& whole = loop.from_start();
  const Study study = unlimited_study(context.study, whole.samples());
  const Eigen::MatrixXd still = Eigen::MatrixXd::Zero(study.cv_count(), whole.samples());
  const LoopSignals signals{
      .d = whole.d, .noise = still, .y_d = still, .y_set = -control_errors(whole, still)};
  const Trajectory nominal = run_closed_loop(study, study.plant.G, signals, context.factory);
  require_ok(nominal);
  return {nominal.u, control_errors(whole, nominal.y), loop.first, loop.samples()};
}

ChannelDifference channel_difference(const TransferFunction& nominal, const TransferFunction& plant,
                                     Eigen::Index cv, Eigen::Index mv, double sample_time,
                                     Eigen::Index samples) {
  Eigen::VectorXd impulse = Eigen::VectorXd::Zero(samples + 1);
  impulse(1) = 1.0;  // inputs are deviations from their first sample
  return {cv, mv,
          (channel_response(plant, sample_time, impulse) - channel_response(nominal, sample_time, impulse))
              .tail(samples)};
}

Eigen::VectorXd theoretical_autocovariance(const LinearLoop& loop, const OutsideMoves& moves,
                                           const std::vector<Eigen::Index>& lags,
                                           const ChannelDifference* changed) {
  const std::optional<AddedPath> path = added_path(loop, changed, moves.u0.cols());
  Eigen::VectorXd mean = loop_autocovariance(moved_outputs(moves, path), lags);
  const std::vector<Eigen::MatrixXd> psi = noise_responses(loop, path);
  const auto count = static_cast<Eigen::Index>(lags.size());
  for (Eigen::Index i = 0; i < moves.z0.rows(); ++i)
    for (Eigen::Index a = 0; a < count; ++a) {
      const Eigen::Index lag = lags[static_cast<std::size_t>(a)];
      mean(i * count + a) += static_cast<double>(moves.samples - lag) / static_cast<double>(moves.samples) *
                             noise_covariance(psi, i, i, lag);
    }
  return mean;
}

Eigen::MatrixXd autocovariance_covariance(const LinearLoop& loop, const OutsideMoves& moves,
                                          const std::vector<Eigen::Index>& lags,
                                          const ChannelDifference* changed, double noise_share) {
  const std::optional<AddedPath> path = added_path(loop, changed, moves.u0.cols());
  const Eigen::MatrixXd z = moved_outputs(moves, path);
  const std::vector<Eigen::MatrixXd> psi = noise_responses(loop, path);
  const auto count = static_cast<Eigen::Index>(lags.size());
  const auto N = static_cast<double>(moves.samples);
  Eigen::MatrixXd covariance(z.rows() * count, z.rows() * count);
  for (Eigen::Index i = 0; i < z.rows(); ++i)
    for (Eigen::Index m = 0; m < z.rows(); ++m) {
      const Eigen::VectorXd g = all_covariances(psi, i, m);
      for (Eigen::Index b = 0; b < count; ++b) {
        const Eigen::Index lag_b = lags[static_cast<std::size_t>(b)];
        const Eigen::VectorXd of_b = correlated(g, twice_shifted(z.row(m).transpose(), lag_b));
        for (Eigen::Index a = 0; a < count; ++a) {
          const Eigen::Index lag_a = lags[static_cast<std::size_t>(a)];
          const double noise = overlap(g, 0, lag_b - lag_a) + overlap(g, lag_b, -lag_a);
          const double common = twice_shifted(z.row(i).transpose(), lag_a).dot(of_b) / N;
          covariance(i * count + a, m * count + b) = (noise_share * noise + common) / N;
        }
      }
    }
  return covariance;
}

}  // namespace mpm
