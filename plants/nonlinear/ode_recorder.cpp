#include "plants/nonlinear/ode_recorder.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {
namespace {

/// An OdeSystem with the integrals of its outputs as further states, q' = g(x, u). The Jacobian lacks dg/dx:
/// nothing depends on q, so that Newton's iteration converges as that of x does.
class WithIntegrals final : public OdeSystem {
 public:
  explicit WithIntegrals(std::shared_ptr<const OdeSystem> of) : of_(std::move(of)) {}

  Eigen::Index state_count() const override { return of_->state_count() + of_->output_count(); }
  Eigen::Index input_count() const override { return of_->input_count(); }
  Eigen::Index output_count() const override { return of_->output_count(); }

  void derivative(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>& u,
                  Eigen::Ref<Eigen::VectorXd> dx) const override {
    of_->derivative(x.head(of_->state_count()), u, dx.head(of_->state_count()));
    of_->output(x.head(of_->state_count()), u, dx.tail(of_->output_count()));
  }
  void jacobian(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>& u,
                Eigen::Ref<Eigen::MatrixXd> J) const override {
    const Eigen::Index n = of_->state_count();
    Eigen::MatrixXd of_x(n, n);
    of_->jacobian(x.head(n), u, of_x);
    J.setZero();
    J.topLeftCorner(n, n) = of_x;
  }
  void output(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>& u,
              Eigen::Ref<Eigen::VectorXd> y) const override {
    of_->output(x.head(of_->state_count()), u, y);
  }
  Eigen::VectorXd steady_state(const Eigen::Ref<const Eigen::VectorXd>& u) const override {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(state_count());
    x.head(of_->state_count()) = of_->steady_state(u);
    return x;
  }

 private:
  std::shared_ptr<const OdeSystem> of_;
};

std::shared_ptr<const OdeSystem> as_sampled(const std::shared_ptr<const OdeSystem>& system,
                                            OutputSampling sampling) {
  return sampling == OutputSampling::average ? std::make_shared<const WithIntegrals>(system) : system;
}

std::vector<double> reading_times(const Eigen::Ref<const Eigen::VectorXd>& delay) {
  std::vector<double> times{1.0};
  for (const double by : delay)
    times.push_back(1.0 - by);
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

}  // namespace

OdeRecorder::OdeRecorder(const std::shared_ptr<const OdeSystem>& system, double sample_time,
                         const OdeOptions& options, const std::shared_ptr<const OdeSystem>& at_rest,
                         Eigen::Index onset, OutputSampling sampling,
                         const Eigen::Ref<const Eigen::VectorXd>& delay)
    : system_(as_sampled(system, sampling)),
      at_rest_(as_sampled(at_rest ? at_rest : system, sampling)),
      sample_time_(sample_time),
      onset_(onset),
      sampling_(sampling),
      delay_(delay),
      times_(reading_times(delay)),
      integrator_(system_, options) {
  if (delay_.size() != system_->output_count() || !(delay_.array() >= 0.0 && delay_.array() < 1.0).all())
    throw InputError("delays of a recorder", fmt::format("{} numbers", delay_.size()),
                     fmt::format("{} numbers from 0 to 1", system_->output_count()));
  if (onset_ > 0)
    before_.emplace(at_rest_, options);
  read_ = output_ = last_part_ = Eigen::VectorXd::Zero(system_->output_count());
}

void OdeRecorder::reset(const Eigen::Ref<const Eigen::VectorXd>& steady_input) {
  const Eigen::VectorXd x = at_rest_->steady_state(steady_input);
  if (!x.allFinite())
    throw NoSteadyState("steady state of the plant", "a number that is not finite", "finite numbers");
  sample_ = 0;
  (is_before_onset() ? *before_ : integrator_).reset(x);
  at_rest_->output(x, steady_input, output_);
  last_part_ = sample_time_ * delay_.cwiseProduct(output_);
}

const Eigen::VectorXd& OdeRecorder::read(const OdeSystem& system, const OdeIntegrator& integrator,
                                         const Eigen::Ref<const Eigen::VectorXd>& input) {
  if (sampling_ == OutputSampling::average)
    read_ = integrator.state().tail(read_.size());
  else
    system.output(integrator.state(), input, read_);
  return read_;
}

PlantStatus OdeRecorder::advance(const Eigen::Ref<const Eigen::VectorXd>& input) {
  OdeIntegrator& now = is_before_onset() ? *before_ : integrator_;
  const OdeSystem& system = is_before_onset() ? *at_rest_ : *system_;
  const bool averages = sampling_ == OutputSampling::average;
  if (averages) {  // integrals of one sample keep the digits that a growing sum would lose
    Eigen::VectorXd x = now.state();
    x.tail(output_.size()).setZero();
    now.reset(x);
  }
  Eigen::VectorXd until_reading = Eigen::VectorXd::Zero(output_.size());
  double from = 0.0;
  for (const double to : times_) {
    if (now.advance(input, (to - from) * sample_time_) != OdeStatus::ok)
      return PlantStatus::failed;
    from = to;
    const Eigen::VectorXd& value = read(system, now, input);
    for (Eigen::Index i = 0; i < output_.size(); ++i)
      if (1.0 - delay_(i) == to) {
        output_(i) = averages ? (last_part_(i) + value(i)) / sample_time_ : value(i);
        until_reading(i) = value(i);
      }
  }
  if (averages)
    last_part_ = read_ - until_reading;
  ++sample_;
  if (before_ && sample_ == onset_)
    integrator_.reset(before_->state());
  return PlantStatus::ok;
}

}  // namespace mpm
