#include "bench/perf/sparse_loop.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "base/system/thread_clock.hpp"
#include "plants/linear/linear_plant.hpp"
#include "scenarios/random/random_stream.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {
namespace {

constexpr std::uint64_t kSeed = 20150401;
constexpr int kStepInterval = 10;  // samples between disturbances
constexpr double kLargestStep = 0.4;
constexpr double kNoise = 0.01;
constexpr double kLag = 15.0;  // samples, of the disturbances that the controller cannot see

RandomStream stream_of(const PlantSize& size, StreamId stream) {
  return {kSeed, static_cast<std::uint64_t>(1000 * size.cvs + size.mvs), stream};
}

Eigen::Index md_count(const PlantSize& size) {
  return std::max(1, size.mvs / 5);
}

double with_sign(RandomStream& random, double low, double high) {
  const double magnitude = random.uniform(low, high);
  return random.below(2) == 0 ? magnitude : -magnitude;
}

TransferFunction random_channel(RandomStream& random) {
  const double gain = with_sign(random, 0.3, 1.5);
  const double time_constant = std::exp(random.uniform(std::log(3.0), std::log(40.0)));
  return TransferFunction::first_order(gain, time_constant, static_cast<double>(random.below(9)));
}

/// Draws `count` different numbers below `all`.
std::vector<int> some_of(RandomStream& random, int all, int count) {
  std::vector<int> numbers(static_cast<std::size_t>(all));
  std::iota(numbers.begin(), numbers.end(), 0);
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
    std::swap(numbers[k], numbers[k + random.below(numbers.size() - k)]);
  numbers.resize(static_cast<std::size_t>(count));
  return numbers;
}

TransferMatrix sparse_model(const PlantSize& size) {
  RandomStream random = stream_of(size, StreamId::mismatch);
  const auto mds = static_cast<int>(md_count(size));
  TransferMatrix model(size.cvs, size.mvs + mds);
  for (int cv = 0; cv < size.cvs; ++cv) {
    for (const int mv : some_of(random, size.mvs, std::max(2, (size.mvs + 2) / 4)))
      model(cv, mv) = random_channel(random);
    model(cv, size.mvs + some_of(random, mds, 1).front()) = random_channel(random);
  }
  return model;
}

MpcOptions range_controller(const PlantSize& size, SlackForm slack) {
  RandomStream random = stream_of(size, StreamId::tuning);
  MpcOptions options;
  options.prediction_horizon = 60;
  options.control_horizon = 10;
  options.move_suppression.setConstant(size.mvs, 25.0);
  options.target_weight.setOnes(size.mvs);
  options.setpoint_weight.setZero(size.cvs);
  options.slack_form = slack;
  options.slack_weight.setConstant(size.cvs, 100.0);
  options.mv_hard = {Eigen::VectorXd::Constant(size.mvs, -1.0), Eigen::VectorXd::Constant(size.mvs, 1.0)};
  options.cv_hard = {Eigen::VectorXd::Constant(size.cvs, -4.0), Eigen::VectorXd::Constant(size.cvs, 4.0)};
  options.cv_soft = {Eigen::VectorXd::Constant(size.cvs, -0.5), Eigen::VectorXd::Constant(size.cvs, 0.5)};
  options.mv_cost.resize(size.mvs);
  for (double& cost : options.mv_cost)
    cost = with_sign(random, 1.0, 8.0);
  return options;
}

/// What acts on a loop from outside: steps of MDs, steps that are added to the CVs behind a lag, and noise.
class Surroundings {
 public:
  explicit Surroundings(const PlantSize& size)
      : md(Eigen::VectorXd::Zero(md_count(size))),
        added(Eigen::VectorXd::Zero(size.cvs)),
        level_(Eigen::VectorXd::Zero(size.cvs)),
        steps_(stream_of(size, StreamId::excitation)),
        noise_(stream_of(size, StreamId::measurement_noise)) {}

  void go_to(int sample) {
    if (sample > 0 && sample % kStepInterval == 0)
      step(sample / kStepInterval % 2 == 0 ? level_ : md);
    lagged_ += (level_ - lagged_) / kLag;
    for (Eigen::Index cv = 0; cv < added.size(); ++cv)
      added(cv) = lagged_(cv) + kNoise * noise_.normal();
  }

  Eigen::VectorXd md, added;

 private:
  void step(Eigen::VectorXd& of) {
    const auto which = static_cast<Eigen::Index>(steps_.below(static_cast<std::uint64_t>(of.size())));
    of(which) = steps_.uniform(-kLargestStep, kLargestStep);
  }

  Eigen::VectorXd level_;
  Eigen::VectorXd lagged_ = level_;
  RandomStream steps_, noise_;
};

/// Hands every program on to another solver and adds up how long that takes.
class TimedSolver final : public QpSolver {
 public:
  TimedSolver(std::unique_ptr<QpSolver> solver, std::shared_ptr<const QpStructure> structure, double& seconds)
      : QpSolver(std::move(structure)), solver_(std::move(solver)), seconds_(seconds) {}

 private:
  void do_solve(const QpData& data, QpResult& result) override {
    const double begin = thread_seconds();
    result = solver_->solve(data);
    seconds_ += thread_seconds() - begin;
  }
  void certify(const QpData& /*data*/, QpResult& /*result*/) override {}  // the other solver has done so
  void do_reset() override { solver_->reset(); }

  std::unique_ptr<QpSolver> solver_;
  double& seconds_;
};

}  // namespace

std::string PlantSize::name() const {
  return fmt::format("{}x{}", cvs, mvs);
}

SparseLoop::SparseLoop(const PlantSize& size, SlackForm slack)
    : size_(size), model_(sparse_model(size)), options_(range_controller(size, slack)) {}

template <class Visit>
void SparseLoop::visit_steps(Mpc& controller, int samples, const Visit& visit) const {
  LinearPlant plant(model_, options_.sample_time);
  Surroundings surroundings(size_);
  Eigen::VectorXd input(model_.cols());
  input << controller.nominal_target(surroundings.md), surroundings.md;
  plant.reset(input);
  controller.reset(input.head(size_.mvs), surroundings.md);
  for (int k = 0; k < samples; ++k) {
    surroundings.go_to(k);
    const Eigen::VectorXd measured = plant.output() + surroundings.added;
    const double begin = thread_seconds();
    const ControlMove& move = controller.step(measured, surroundings.md);
    visit(k, thread_seconds() - begin, move);
    input << move.u, surroundings.md;
    plant.advance(input);
  }
}

SparseLoop::Times SparseLoop::run(const QpSolverFactory& factory, int samples) const {
  Times times;
  const auto timed = [&](const std::shared_ptr<const QpStructure>& structure) -> std::unique_ptr<QpSolver> {
    double& seconds = structure->hessian.isZero(0.0) ? times.targets : times.moves;
    return std::make_unique<TimedSolver>(factory(structure), structure, seconds);
  };
  const double begin = thread_seconds();
  Mpc controller(model_, size_.mvs, options_, timed);
  times.making = thread_seconds() - begin;
  visit_steps(controller, samples, [&](int, double seconds, const ControlMove& move) {
    times.step.push_back(1e6 * seconds);
    times.iterations += controller.move_problem()->result.iterations / static_cast<double>(samples);
    times.kkt_residual = std::max(times.kkt_residual, move.kkt_residual);
    times.not_solved += move.status == ControlStatus::ok ? 0 : 1;
  });
  return times;
}

SparseLoop::Programs SparseLoop::programs(int first, int count) const {
  Programs programs;
  Mpc controller(model_, size_.mvs, options_, qp_solver_factory("active-set"));
  visit_steps(controller, first + count, [&](int sample, double, const ControlMove&) {
    if (sample < first)
      return;
    const SolvedQp solved = *controller.move_problem();
    programs.structure = solved.structure;
    programs.data.push_back(solved.data);
    programs.answers.push_back(solved.result.x);
  });
  return programs;
}

}  // namespace mpm
