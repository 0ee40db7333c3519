#include "analysis/identification/shared_whitening.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/identification/sum_of_outer_products.hpp"
#include "base/row_major.hpp"

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

/// The filter for one disturbance model. The state is [x(k), x(k-1), then for each series the states of its
/// channel and its slow noise]. A series depends on x(k-1), its channel and its noise alone, so that F and H
/// act on rows.
class SharedWhitening::Filter {
 public:
  Filter(const SharedWhitening& of, double a, double b, Eigen::Index rows)
      : outputs_(of.outputs_),
        a_(a),
        Q_(Eigen::VectorXd::Zero(of.states_)),
        K_(Eigen::MatrixXd::Zero(of.states_, static_cast<Eigen::Index>(outputs_.size()))),
        root_S_(Eigen::VectorXd::Ones(K_.cols())),
        log_S_(Eigen::VectorXd::Zero(K_.cols())),
        previous_(Eigen::VectorXd::Zero(of.states_)),
        state_(RowMajorMatrix::Zero(of.states_, rows)),
        next_(state_) {
    Q_(0) = b * b;
    Eigen::Index at = kInputStates;
    for (const SharedOutput& output : outputs_) {
      first_.push_back(at);
      at += output.states();
      if (output.has_slow_noise())
        Q_(at - 1) = output.b * output.b;
    }
    RowMajorMatrix F(of.states_, of.states_);
    propagate(RowMajorMatrix::Identity(of.states_, of.states_), F);
    P_ = stationary_covariance(F, Q_.asDiagonal());
  }

  SharedProducts run(Eigen::Index first, Eigen::Index last) {
    const Eigen::Index rows = state_.cols();
    SharedProducts sums{Eigen::VectorXd::Zero(K_.cols()), {}};
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
      sums.products.emplace_back(each.lower());
    return sums;
  }

 private:
  /// next = F M
  void propagate(const RowMajorMatrix& M, RowMajorMatrix& next) const {
    next.row(0) = a_ * M.row(0);
    next.row(1) = M.row(0);
    for (std::size_t i = 0; i < outputs_.size(); ++i) {
      const DiscreteChannel& channel = outputs_[i].channel;
      const Eigen::Index at = first_[i], n = channel.A.rows();
      for (Eigen::Index r = 0; r < n; ++r) {
        next.row(at + r) = channel.b_now(r) * M.row(0) + channel.b_previous(r) * M.row(1);
        for (Eigen::Index c = 0; c < n; ++c)
          if (channel.A(r, c) != 0.0)
            next.row(at + r) += channel.A(r, c) * M.row(at + c);
      }
      if (outputs_[i].has_slow_noise())
        next.row(at + n) = outputs_[i].a * M.row(at + n);
    }
  }

  /// seen = H_i' M
  template <class States>
  void observe_state(std::size_t i, const States& M, Eigen::RowVectorXd& seen) const {
    const DiscreteChannel& channel = outputs_[i].channel;
    const Eigen::Index n = channel.A.rows();
    seen = channel.d * M.row(1);
    for (Eigen::Index r = 0; r < n; ++r)
      seen += channel.c(r) * M.row(first_[i] + r);
    if (outputs_[i].has_slow_noise())
      seen += M.row(first_[i] + n);
  }

  /// Finds which series have a sample. Returns whether they are the same as at the sample before.
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
      renew(i, outputs_[i].white);
    const auto z = outputs_[i].series->col(k + outputs_[i].channel.delay);
    observe_state(i, state_, innovation_);
    innovation_ = -innovation_;
    innovation_(0) += z(0);
    if (state_.cols() > 1)
      innovation_.segment(own_row, z.size() - 1) += z.tail(z.size() - 1).transpose();
    state_.noalias() += K_.col(column) * innovation_;
    products.next() = innovation_.transpose() / root_S_(column);
  }

  /// Updates the gain and the variance of the innovation of a series, given the series before it in the same
  /// sample.
  void renew(std::size_t i, double white) {
    const auto column = static_cast<Eigen::Index>(i);
    observe_state(i, P_, covariance_);
    observe_state(i, covariance_.transpose(), variance_);
    const double S = variance_(0) + white * white;
    root_S_(column) = std::sqrt(S);
    log_S_(column) = std::log(S);
    K_.col(column) = covariance_.transpose() / S;
    P_.noalias() -= K_.col(column) * covariance_;
  }

  void advance(bool same, bool settled) {
    propagate(state_, next_);
    state_.swap(next_);
    if (settled)
      return;
    const Eigen::VectorXd before = P_.diagonal();
    next_P_.resizeLike(P_);
    propagate(P_, next_P_);
    turned_ = next_P_.transpose();
    propagate(turned_, P_);
    P_.diagonal() += Q_;
    settled_ = same && ((before - previous_).cwiseAbs().array() <= kSteady * (1e-12 + before.array())).all();
    previous_ = before;
  }

  const std::vector<SharedOutput>& outputs_;
  std::vector<Eigen::Index> first_;  ///< first state of each series
  double a_;
  Eigen::VectorXd Q_;  ///< diagonal
  Eigen::MatrixXd K_;
  Eigen::VectorXd root_S_, log_S_, previous_;
  RowMajorMatrix state_, next_, P_, next_P_, turned_;
  Eigen::RowVectorXd innovation_, covariance_, variance_;
  std::vector<bool> observed_;
  bool settled_ = false;
};

SharedWhitening::SharedWhitening(std::vector<SharedOutput> outputs)
    : outputs_(std::move(outputs)), states_(kInputStates), rows_(1), longest_delay_(0) {
  for (const SharedOutput& output : outputs_) {
    states_ += output.states();
    rows_ += output.series->rows() - 1;
    longest_delay_ = std::max<Eigen::Index>(longest_delay_, output.channel.delay);
  }
}

SharedProducts SharedWhitening::products(double a, double b, bool rows) const {
  return Filter(*this, a, b, rows ? rows_ : 1).run(-longest_delay_, outputs_.front().series->cols());
}

}  // namespace mpm
