#include "bench/perf/qp_sequence.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {
namespace {

struct RecordedLoop {
  const char* name;
  std::int64_t experiment;  // of chapter6 with its own seed
};

// Chosen from an archive of chapter6: among the feasible experiments of its kind, 222 has the Ivar farthest
// from 1 (time constant of y2-u2 times 2.8), 185 the most solver iterations.
constexpr std::array<RecordedLoop, 3> kLoops{{{"quiet", kBasisIndex}, {"mpm", 222}, {"ud", 185}}};

/// Hands every program on to another solver and keeps a copy of it.
class RecordingSolver final : public QpSolver {
 public:
  RecordingSolver(std::unique_ptr<QpSolver> solver, std::shared_ptr<const QpStructure> structure,
                  std::vector<QpData>& record)
      : QpSolver(std::move(structure)), solver_(std::move(solver)), record_(record) {}

 private:
  void do_solve(const QpData& data, QpResult& result) override {
    record_.push_back(data);
    result = solver_->solve(data);
  }
  void do_reset() override {
    record_.clear();  // the search for the operating point, before the loop begins, is no part of it
    solver_->reset();
  }

  std::unique_ptr<QpSolver> solver_;
  std::vector<QpData>& record_;
};

// Of the two problems of a controller only (6.19) is a linear program.
std::string problem_of(const QpStructure& structure) {
  return structure.hessian.isZero(0.0) ? "targets" : "moves";
}

std::array<QpSequence, 2> record(const Study& study, const ExperimentDraw& draw) {
  std::array<QpSequence, 2> sequences;
  const QpSolverFactory active_set = qp_solver_factory("active-set");
  std::size_t made = 0;
  simulate_experiment(study, draw, [&](const std::shared_ptr<const QpStructure>& structure) {
    QpSequence& sequence = sequences.at(made++);
    sequence.structure = structure;
    sequence.problem = problem_of(*structure);
    return std::make_unique<RecordingSolver>(active_set(structure), structure, sequence.data);
  });
  return sequences;
}

std::string description(const ExperimentDraw& draw) {
  if (!draw.mismatches.empty()) {
    const Mismatch& mismatch = draw.mismatches.front();
    return fmt::format("{} of channel ({}, {}): {:.4g}", to_string(mismatch.parameter), mismatch.cv + 1,
                       mismatch.input + 1, mismatch.value);
  }
  if (!draw.disturbances.empty()) {
    const Disturbance& disturbance = draw.disturbances.front();
    return fmt::format("disturbance of y{}: gain {:.4g}, time constant {:.4g}", disturbance.cv + 1,
                       disturbance.gain, disturbance.time_constant);
  }
  return "basis case";
}

}  // namespace

std::string QpSequence::name() const {
  return fmt::format("{}/{}/{}", problem, slack, loop);
}

QpSequence QpSequence::part(std::size_t first, std::size_t count) const {
  QpSequence result{problem, slack, loop, loop_text, structure, {}};
  for (std::size_t k = first; k < std::min(first + count, data.size()); ++k)
    result.data.push_back(data[k]);
  return result;
}

ExperimentDraw recorded_draw(const Study& study, const std::string& loop) {
  for (const RecordedLoop& known : kLoops)
    if (loop == known.name)
      return known.experiment == kBasisIndex ? basis_draw() : draw_experiment(study, known.experiment);
  throw InputError("recorded loop", fmt::format("\"{}\"", loop), "quiet, mpm, ud");
}

std::vector<QpSequence> recorded_sequences(const Study& study) {
  std::vector<QpSequence> result;
  for (const SlackForm form : {SlackForm::per_sample, SlackForm::per_cv}) {
    Study variant = study;
    variant.controller.slack_form = form;
    for (const RecordedLoop& loop : kLoops) {
      const ExperimentDraw draw = recorded_draw(variant, loop.name);
      for (QpSequence& sequence : record(variant, draw)) {
        sequence.slack = to_string(form);
        sequence.loop = loop.name;
        sequence.loop_text = description(draw);
        result.push_back(std::move(sequence));
      }
    }
  }
  return result;
}

}  // namespace mpm
