#include "analysis/methods/loop_autocovariance.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "analysis/methods/channel_regressors.hpp"
#include "analysis/methods/noise_model.hpp"
#include "analysis/methods/prewhitened_groups.hpp"
#include "analysis/statistics/discrete_filter.hpp"
#include "plants/error.hpp"
#include "scenarios/closed_loop.hpp"

namespace mpm {
namespace {

/// sum_l h(l) x(k - l), as long as x.
Eigen::VectorXd convolved(const Eigen::VectorXd& h, const Eigen::VectorXd& x) {
  const Eigen::VectorXd reversed = h.reverse();
  Eigen::VectorXd y(x.size());
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const Eigen::Index n = std::min(k + 1, h.size());
    y(k) = reversed.tail(n).dot(x.segment(k + 1 - n, n));
  }
  return y;
}

/// u = x + f u with f(0) = 0.
Eigen::VectorXd closed(const Eigen::VectorXd& f, const Eigen::VectorXd& x) {
  const Eigen::VectorXd reversed = f.reverse();
  Eigen::VectorXd u = x;
  for (Eigen::Index k = 1; k < x.size(); ++k) {
    const Eigen::Index n = std::min(k, f.size() - 1);
    u(k) += reversed.segment(f.size() - 1 - n, n).dot(u.segment(k - n, n));
  }
  return u;
}

/// Column of a step response to its impulse response.
Eigen::MatrixXd differences(const Eigen::MatrixXd& step_response, double size) {
  Eigen::MatrixXd impulse_response = step_response / size;
  const Eigen::Index n = step_response.cols() - 1;
  impulse_response.rightCols(n) -= step_response.leftCols(n) / size;
  return impulse_response;
}

/// The study without any limit and with nothing that moves its loops.
Study unlimited_study(const Study& study, Eigen::Index samples) {
  Study unlimited = study;
  unlimited.controller.mv_hard = Limits::none(study.mv_count());
  unlimited.controller.cv_hard = Limits::none(study.cv_count());
  unlimited.simulation.samples = static_cast<int>(samples);
  unlimited.simulation.limit_steps.clear();
  return unlimited;
}

void require_ok(const Trajectory& loop) {
  if (loop.status != ControlStatus::ok)
    throw InputError("controller", "one without a solution when no limit is left", "one with");
}

/// n of the CVs under an impulse in w_l, ny x L.
Eigen::MatrixXd noise_response(const LinearLoop& loop, std::size_t l, const ChannelDifference* changed) {
  const Eigen::Index ny = loop.s.front().rows();
  const Eigen::VectorXd& v = loop.noise[l];
  Eigen::VectorXd of_change;
  if (changed) {
    const auto i = static_cast<std::size_t>(changed->cv);
    const Eigen::VectorXd f = convolved(loop.q[i].row(changed->mv).transpose(), changed->D);
    const Eigen::VectorXd u = closed(f, convolved(loop.q[l].row(changed->mv).transpose(), v));
    of_change = convolved(changed->D, u);
  }
  Eigen::MatrixXd response(ny, v.size());
  for (Eigen::Index m = 0; m < ny; ++m) {
    response.row(m) = convolved(loop.s[l].row(m).transpose(), v).transpose();
    if (changed)
      response.row(m) +=
          convolved(loop.s[static_cast<std::size_t>(changed->cv)].row(m).transpose(), of_change).transpose();
  }
  return response;
}

std::vector<Eigen::MatrixXd> noise_responses(const LinearLoop& loop, const ChannelDifference* changed) {
  std::vector<Eigen::MatrixXd> responses;
  for (std::size_t l = 0; l < loop.noise.size(); ++l)
    responses.push_back(noise_response(loop, l, changed));
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
Eigen::MatrixXd moved_outputs(const LinearLoop& loop, const OutsideMoves& moves,
                              const ChannelDifference* changed) {
  Eigen::MatrixXd z = moves.z0;
  if (changed) {
    const auto i = static_cast<std::size_t>(changed->cv);
    const Eigen::VectorXd f = convolved(loop.q[i].row(changed->mv).transpose(), changed->D);
    const Eigen::VectorXd e = convolved(changed->D, closed(f, moves.u0.row(changed->mv).transpose()));
    for (Eigen::Index m = 0; m < z.rows(); ++m)
      z.row(m) += convolved(loop.s[i].row(m).transpose(), e).transpose();
  }
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

/// sum_t g(t + a) g(t + b) of a g that is 0 beyond its ends.
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
  LinearLoop loop{.sample_time = study.controller.sample_time, .q = {}, .s = {}, .noise = {}};
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
    loop.noise.emplace_back(std::sqrt(innovation_variance(v, kHighestNoiseOrder)) *
                            filter(model.C, model.D, impulse));
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
  Eigen::VectorXd mean = loop_autocovariance(moved_outputs(loop, moves, changed), lags);
  const std::vector<Eigen::MatrixXd> psi = noise_responses(loop, changed);
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
  const Eigen::MatrixXd z = moved_outputs(loop, moves, changed);
  const std::vector<Eigen::MatrixXd> psi = noise_responses(loop, changed);
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
