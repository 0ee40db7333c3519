#include "analysis/identification/shared_whitening.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/identification/sum_of_outer_products.hpp"

namespace mpm {
namespace {

constexpr int kDoublings = 10;            // of the time in which the state becomes stationary
constexpr double kSteady = 1e-9;          // relative change of the variance of every state in a sample
constexpr Eigen::Index kInputStates = 2;  // states of x: now and a sample ago

/// sum over k of F^k Q F'^k, k < 2^kDoublings.
Eigen::MatrixXd stationary_covariance(Eigen::MatrixXd F, Eigen::MatrixXd Q) {
  for (int i = 0; i < kDoublings; ++i) {
    Q += (F * Q * F.transpose()).eval();
    F = (F * F).eval();
  }
  return Q;
}

}  // namespace

/// The filter under one disturbance. The state is [x(k), x(k-1), those of each channel, each slow noise].
class SharedWhitening::Filter {
 public:
  Filter(const SharedWhitening& of, double a, double b, Eigen::Index rows)
      : outputs_(of.outputs_),
        F_(Eigen::MatrixXd::Zero(of.states_, of.states_)),
        Q_(Eigen::MatrixXd::Zero(of.states_, of.states_)),
        H_(Eigen::MatrixXd::Zero(of.states_, static_cast<Eigen::Index>(outputs_.size()))),
        K_(H_),
        S_(Eigen::VectorXd::Ones(H_.cols())),
        root_S_(S_),
        log_S_(Eigen::VectorXd::Zero(H_.cols())),
        state_(Eigen::MatrixXd::Zero(of.states_, rows)),
        next_(state_) {
    F_(0, 0) = a;
    Q_(0, 0) = b * b;
    F_(1, 0) = 1.0;
    Eigen::Index at = kInputStates;
    for (std::size_t i = 0; i < outputs_.size(); ++i)
      at = add(outputs_[i], static_cast<Eigen::Index>(i), at);
    P_ = stationary_covariance(F_, Q_);
  }

  SharedProducts run(Eigen::Index first, Eigen::Index last) {
    const Eigen::Index rows = state_.cols();
    SharedProducts sums{Eigen::VectorXd::Zero(S_.size()), {}};
    std::vector<SumOfOuterProducts> products(outputs_.size(), SumOfOuterProducts(rows));
    for (Eigen::Index k = first; k < last; ++k) {
      const bool same = find_observed(k);
      const bool settled = same && settled_;
      for (std::size_t i = 0, row = 1; i < outputs_.size(); ++i) {
        const auto own = static_cast<Eigen::Index>(row);
        row += static_cast<std::size_t>(outputs_[i].series->rows() - 1);
        if (observed_[i]) {
          observe(i, k, own, settled, products[i]);
          sums.log_determinant(static_cast<Eigen::Index>(i)) += log_S_(static_cast<Eigen::Index>(i));
        }
      }
      advance(same, settled);
    }
    for (SumOfOuterProducts& each : products)
      sums.products.emplace_back(each.lower().selfadjointView<Eigen::Lower>());
    return sums;
  }

 private:
  /// The states of one series from `at` on; where those of the next one begin.
  Eigen::Index add(const SharedOutput& output, Eigen::Index i, Eigen::Index at) {
    const DiscreteChannel& channel = output.channel;
    const Eigen::Index n = channel.A.rows();
    F_.block(at, at, n, n) = channel.A;
    F_.block(at, 0, n, 1) = channel.b_now;
    F_.block(at, 1, n, 1) = channel.b_previous;
    H_.block(at, i, n, 1) = channel.c.transpose();
    H_(1, i) = channel.d;
    at += n;
    if (output.b == 0.0)
      return at;
    F_(at, at) = output.a;
    Q_(at, at) = output.b * output.b;
    H_(at, i) = 1.0;
    return at + 1;
  }

  /// Which series have a sample; whether they are those of the sample before.
  bool find_observed(Eigen::Index k) {
    bool same = !observed_.empty();
    observed_.resize(outputs_.size(), false);
    for (std::size_t i = 0; i < outputs_.size(); ++i) {
      const Eigen::Index own = k + outputs_[i].channel.delay;
      const bool there =
          own >= 0 && own < outputs_[i].series->cols() && !std::isnan((*outputs_[i].series)(0, own));
      same = same && observed_[i] == there;
      observed_[i] = there;
    }
    return same;
  }

  void observe(std::size_t i, Eigen::Index k, Eigen::Index own_row, bool settled,
               SumOfOuterProducts& products) {
    const auto column = static_cast<Eigen::Index>(i);
    if (!settled)
      renew(column, outputs_[i].white);
    const auto z = outputs_[i].series->col(k + outputs_[i].channel.delay);
    innovation_ = -(H_.col(column).transpose() * state_);
    innovation_(0) += z(0);
    if (state_.cols() > 1)
      innovation_.segment(own_row, z.size() - 1) += z.tail(z.size() - 1).transpose();
    state_.noalias() += K_.col(column) * innovation_;
    products.next() = innovation_.transpose() / root_S_(column);
  }

  /// Gain and variance of the innovation of a series, given the series before it in the same sample.
  void renew(Eigen::Index column, double white) {
    const Eigen::VectorXd covariance = P_ * H_.col(column);
    S_(column) = H_.col(column).dot(covariance) + white * white;
    root_S_(column) = std::sqrt(S_(column));
    log_S_(column) = std::log(S_(column));
    K_.col(column) = covariance / S_(column);
    P_.noalias() -= K_.col(column) * covariance.transpose();
  }

  void advance(bool same, bool settled) {
    next_.noalias() = F_ * state_;
    state_.swap(next_);
    if (settled)
      return;
    const Eigen::VectorXd before = P_.diagonal();
    P_ = (F_ * P_ * F_.transpose() + Q_).eval();
    settled_ = same && ((before - previous_).cwiseAbs().array() <= kSteady * (1e-12 + before.array())).all();
    previous_ = before;
  }

  const std::vector<SharedOutput>& outputs_;
  Eigen::MatrixXd F_, Q_, H_, K_, P_;
  Eigen::VectorXd S_, root_S_, log_S_, previous_ = Eigen::VectorXd::Zero(F_.rows());
  Eigen::MatrixXd state_, next_;
  Eigen::RowVectorXd innovation_;
  std::vector<bool> observed_;
  bool settled_ = false;
};

SharedWhitening::SharedWhitening(std::vector<SharedOutput> outputs)
    : outputs_(std::move(outputs)), states_(kInputStates), rows_(1), longest_delay_(0) {
  for (const SharedOutput& output : outputs_) {
    states_ += output.channel.A.rows() + (output.b == 0.0 ? 0 : 1);
    rows_ += output.series->rows() - 1;
    longest_delay_ = std::max<Eigen::Index>(longest_delay_, output.channel.delay);
  }
}

SharedProducts SharedWhitening::products(double a, double b, bool rows) const {
  return Filter(*this, a, b, rows ? rows_ : 1).run(-longest_delay_, outputs_.front().series->cols());
}

}  // namespace mpm
